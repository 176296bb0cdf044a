#pragma once

#include <optional>
#include <string>
#include <vector>

#include "components/render.hpp"
#include "engine/io/gltf_skin.hpp"
#include "game/render/renderer.hpp"
#include "systems/rigs/body_rig_fit.hpp"

// Bodies as they are drawn: the robot's, or a loaded figure.
namespace handhold {

struct BodyModel {
    SkinnedMesh figure;
    BodyRig rig;
};

BodyModel builtin_body_model();
// Of a command line: a figure and how its joints are called, both may be empty: then the robot's,
// and names tell.
Result<BodyModel> choose_body_model(const std::string& figure_file, const std::string& map_file);

// The meshes of one body in one renderer. Every player of a picture is added again for each
// picture. What hangs on the figure's hands is never drawn: hands have rigs of their own
// (HandFigures).
class BodyFigures {
  public:
    // Whose eyes the picture is from has no head, neck and collar.
    enum class Seen { by_others, by_himself };

    BodyFigures(BodyModel model, Renderer& renderer);

    void begin();  // a new picture
    void add(const BodyMeasures& measures, const RenderPose& render, Seen seen, Renderer& renderer,
             RenderFrame& frame);

  private:
    // Triangles of one material, with vertices of their own.
    struct Piece {
        std::vector<std::uint32_t> vertices;  // of the figure
        std::vector<std::array<std::uint32_t, 3>> triangles;
        Color color{};
        Look look;
        bool is_head = false;
    };
    using Copy = std::vector<MeshId>;  // of one player, by piece

    void cut_pieces();
    Copy make_copy(Renderer& renderer) const;

    BodyModel model_;
    std::vector<Piece> pieces_;
    std::vector<Copy> copies_;
    std::size_t used_ = 0;  // copies in this picture
    SkeletonPose pose_;     // scratch, as what follows
    std::vector<Vec3> positions_, normals_, piece_positions_, piece_normals_;
};

}  // namespace handhold

#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "components/render.hpp"
#include "engine/io/gltf_skin.hpp"
#include "game/render/renderer.hpp"
#include "systems/rigs/body_rig_fit.hpp"

// Draws players' bodies: the built-in robot, or a figure loaded from a file.
namespace handhold {

struct BodyModel {
    SkinnedMesh figure;
    BodyRig rig;
};

BodyModel builtin_body_model();
// Loads a figure and a joint map; either name may be empty. Without a figure, returns the built-in
// robot. Without a map, the figure's VRM table or its joint names determine the bones.
Result<BodyModel> choose_body_model(const std::string& figure_file, const std::string& map_file);

// Meshes of one body model in one renderer. For each picture, call begin(), then add() for every
// player. The figure's own hands are drawn if the fingers of both are recognised; else they are
// left out, and HandFigures draws hands.
class BodyFigures {
  public:
    // by_himself: the picture is from the player's eyes; head, neck and collar are not drawn.
    enum class Seen { by_others, by_himself };

    BodyFigures(BodyModel model, Renderer& renderer);

    void begin();  // starts a new picture
    // Colour of the robot's shell from now on; nullopt: its own. Loaded figures keep theirs.
    void paint_shell(const std::optional<Color>& color) { shell_ = color; }
    // `hands`: joints of the shown hands, which the figure's fingers follow.
    void add(const BodyMeasures& measures, const RenderPose& render,
             const std::array<PosedHandJoints, k_hand_count>& hands, Seen seen, Renderer& renderer,
             RenderFrame& frame);
    // True if the figure's hands are the player's hands.
    bool has_hands() const;

  private:
    // Triangles of one material with their own vertices.
    struct Piece {
        std::vector<std::uint32_t> vertices;  // indices into the figure's vertices
        std::vector<std::array<std::uint32_t, 3>> triangles;
        Color color{};
        Look look;
        bool is_head = false;
    };
    using Copy = std::vector<MeshId>;  // meshes of one player, indexed as pieces_

    void cut_pieces();
    Copy make_copy(Renderer& renderer) const;

    BodyModel model_;
    std::optional<Color> shell_;
    std::vector<Piece> pieces_;
    std::vector<Copy> copies_;
    std::size_t used_ = 0;  // copies used in this picture
    SkeletonPose pose_;     // scratch, as are the vectors below
    std::vector<Vec3> positions_, normals_, piece_positions_, piece_normals_;
};

}  // namespace handhold

#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "game/mesh/loft.hpp"

// Building kit of the robot's figures: solids grouped by material.
namespace handhold {

enum class FigureMaterial { shell, joint, accent, metal };
inline constexpr std::size_t k_figure_material_count = 4;

// One section of a loft along +Z: a rounded rectangle centred at (x, y). Precondition: the corner
// radius is below both half sizes.
struct LoftSection {
    double z_m, half_x_m, half_y_m, corner_m, x_m, y_m;
};
Mesh loft_sections(std::span<const LoftSection> sections);

// Collects the solids of one figure, one mesh per material.
class FigureKit {
  public:
    void add(FigureMaterial material, const Mesh& solid, const Pose& at = {});
    void mirror();  // mirrors all surfaces through x = 0
    // All parts, transformed by `at`.
    FigureKit placed(const Pose& at) const;

    // The meshes that have triangles, welded, coloured and named "<name>/shell", ...
    std::vector<Mesh> finish(const std::string& name) const;
    // The mesh of one material; may be empty.
    Mesh finish(FigureMaterial material, const std::string& name) const;

  private:
    std::array<Mesh, k_figure_material_count> meshes_;
};

const char* figure_material_text(FigureMaterial material);
std::array<float, 3> figure_color(FigureMaterial material);
float figure_gloss(FigureMaterial material);

// Figures are built along +Z; half a turn about Y makes them point forward.
const Pose& figure_forward();

}  // namespace handhold

#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "game/render/loft.hpp"

// What the robot's figures are built with: solids sorted by what they are made of.
namespace handhold {

enum class FigureMaterial { shell, joint, accent, metal };
inline constexpr std::size_t k_figure_material_count = 4;

// One step of a loft along +Z: a rounded rectangle about (x, y). Precondition: the corner is below
// both halves.
struct LoftSection {
    double z_m, half_x_m, half_y_m, corner_m, x_m, y_m;
};
Mesh loft_sections(std::span<const LoftSection> sections);

// Collects the solids of one figure, a mesh a material.
class FigureKit {
  public:
    void add(FigureMaterial material, const Mesh& solid, const Pose& at = {});
    void mirror();  // through x = 0
    // All parts, turned and moved.
    FigureKit placed(const Pose& at) const;

    // The meshes that have triangles, welded, coloured and named "<name>/shell", ...
    std::vector<Mesh> finish(const std::string& name) const;
    // Of one material; it may be empty.
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

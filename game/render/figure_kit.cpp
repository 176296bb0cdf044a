#include "game/render/figure_kit.hpp"

#include "game/mesh/mesh_edit.hpp"

namespace handhold {

Mesh loft_sections(std::span<const LoftSection> sections) {
    std::vector<Ring> rings;
    for (const LoftSection& s : sections) {
        Ring ring = make_outline({s.half_x_m, s.half_y_m, s.corner_m, 5, 1}, s.z_m);
        for (Vec3& point : ring) {
            point += Vec3(s.x_m, s.y_m, 0.0);
        }
        rings.push_back(std::move(ring));
    }
    return make_loft(rings, LoftEnds::capped);
}

const char* figure_material_text(FigureMaterial material) {
    constexpr std::array k_names = {"shell", "joints", "accent", "metal"};
    return k_names[static_cast<std::size_t>(material)];
}

std::array<float, 3> figure_color(FigureMaterial material) {
    constexpr std::array<std::array<float, 3>, k_figure_material_count> k_colors = {
        {{0.78F, 0.77F, 0.74F},
         {0.045F, 0.048F, 0.055F},
         {0.85F, 0.24F, 0.04F},
         {0.33F, 0.34F, 0.36F}}};
    return k_colors[static_cast<std::size_t>(material)];
}

float figure_gloss(FigureMaterial material) {
    constexpr std::array<float, k_figure_material_count> k_gloss = {0.45F, 0.15F, 0.35F, 0.70F};
    return k_gloss[static_cast<std::size_t>(material)];
}

const Pose& figure_forward() {
    static const Pose pose{Vec3::Zero(), Quat(0.0, 0.0, 1.0, 0.0)};
    return pose;
}

void FigureKit::add(FigureMaterial material, const Mesh& solid, const Pose& at) {
    append(meshes_[static_cast<std::size_t>(material)], solid, at);
}

void FigureKit::mirror() {
    for (Mesh& mesh : meshes_) {
        mirror_x(mesh);
    }
}

FigureKit FigureKit::placed(const Pose& at) const {
    FigureKit kit;
    for (std::size_t i = 0; i < meshes_.size(); ++i) {
        append(kit.meshes_[i], meshes_[i], at);
    }
    return kit;
}

Mesh FigureKit::finish(FigureMaterial material, const std::string& name) const {
    Mesh mesh = meshes_[static_cast<std::size_t>(material)];
    weld(mesh);
    mesh.name = name + "/" + figure_material_text(material);
    mesh.color = figure_color(material);
    return mesh;
}

std::vector<Mesh> FigureKit::finish(const std::string& name) const {
    std::vector<Mesh> meshes;
    for (std::size_t i = 0; i < k_figure_material_count; ++i) {
        if (!meshes_[i].triangles.empty()) {
            meshes.push_back(finish(static_cast<FigureMaterial>(i), name));
        }
    }
    return meshes;
}

}  // namespace handhold

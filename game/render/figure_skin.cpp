#include "game/render/figure_skin.hpp"

#include "game/mesh/shading_mesh.hpp"

namespace handhold {

void FigureSkin::add(FigureMaterial material, const Mesh& part, const Pose& at,
                     std::uint16_t joint) {
    GltfSkinSurface& surface = surfaces_[static_cast<std::size_t>(material)];
    const ShadingMesh shading = make_shading_mesh(part);
    const auto first = static_cast<std::uint32_t>(surface.vertices.size());
    for (std::size_t i = 0; i + 5 < shading.vertices.size(); i += 6) {
        const float* const v = shading.vertices.data() + i;
        const Vec3 position = Eigen::Vector3f(v[0], v[1], v[2]).cast<double>() + shading.center;
        const Vec3 normal = Eigen::Vector3f(v[3], v[4], v[5]).cast<double>();
        const Eigen::Vector3f position_ms = transform_point(at, position).cast<float>();
        const Eigen::Vector3f normal_ms = (at.rotation * normal).cast<float>();
        surface.vertices.push_back({{position_ms.x(), position_ms.y(), position_ms.z()},
                                    {normal_ms.x(), normal_ms.y(), normal_ms.z()}});
        surface.weights.push_back({{joint, 0, 0, 0}, {1.0F, 0.0F, 0.0F, 0.0F}});
    }
    for (const std::uint32_t index : shading.indices) {
        surface.indices.push_back(first + index);
    }
}

void FigureSkin::add(const FigureKit& kit, const Pose& at, std::uint16_t joint,
                     const std::string& name) {
    for (std::size_t i = 0; i < k_figure_material_count; ++i) {
        const auto material = static_cast<FigureMaterial>(i);
        add(material, kit.finish(material, name), at, joint);
    }
}

GltfSkin FigureSkin::finish(std::vector<SkinJoint> joints) const {
    GltfSkin skin;
    skin.name = name_;
    skin.joints = std::move(joints);
    for (std::size_t i = 0; i < k_figure_material_count; ++i) {
        if (!surfaces_[i].indices.empty()) {
            skin.surfaces.push_back(surfaces_[i]);
            skin.surfaces.back().material = i;
        }
    }
    return skin;
}

std::vector<GltfMaterial> FigureSkin::materials() {
    std::vector<GltfMaterial> materials;
    for (std::size_t i = 0; i < k_figure_material_count; ++i) {
        const auto material = static_cast<FigureMaterial>(i);
        materials.push_back({figure_material_text(material), figure_color(material), 0.0F, 1.0F,
                             figure_gloss(material)});
    }
    return materials;
}

}  // namespace handhold

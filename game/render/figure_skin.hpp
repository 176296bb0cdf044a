#pragma once

#include <array>
#include <string>
#include <vector>

#include "engine/io/gltf_skin_writer.hpp"
#include "game/render/figure_kit.hpp"

// Builds a skinned figure for a glTF file from rigid parts, with one surface per material.
namespace handhold {

class FigureSkin {
  public:
    explicit FigureSkin(std::string name) : name_(std::move(name)) {}

    // Adds a part with pose `at` in the figure's frame, rigidly bound to one joint.
    void add(FigureMaterial material, const Mesh& part, const Pose& at, std::uint16_t joint);
    // Adds all parts of a kit.
    void add(const FigureKit& kit, const Pose& at, std::uint16_t joint, const std::string& name);

    // For write_skinned_glb: the skin on these joints, and the materials of its surfaces.
    GltfSkin finish(std::vector<SkinJoint> joints) const;
    static std::vector<GltfMaterial> materials();

  private:
    std::string name_;
    std::array<GltfSkinSurface, k_figure_material_count> surfaces_;  // indexed by FigureMaterial
};

}  // namespace handhold

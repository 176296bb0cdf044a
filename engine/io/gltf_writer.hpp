#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

// Geometry into glTF 2.0. Source: Khronos glTF 2.0 specification, sections 3.5 to 3.9 and 4; what
// glows beyond white, KHR_materials_emissive_strength.
namespace handhold {

struct GltfMaterial {
    std::string name;
    std::array<float, 3> color = {0.5F, 0.5F, 0.5F};  // linear RGB in [0, 1]
    float emissive = 0.0F;                            // times the colour; >= 0
    float opacity = 1.0F;                             // [0, 1]
    float gloss = 0.25F;                              // [0, 1]: 1 - roughness
};

struct GltfVertex {
    std::array<float, 3> position = {};
    std::array<float, 3> normal = {};  // unit
};

// One mesh of one material, and the node that shows it.
struct GltfSurface {
    std::string group;  // name of the node above it; neighbours of one group share the node
    std::string name;
    std::vector<GltfVertex> vertices;
    std::vector<std::uint32_t> indices;  // three a triangle, counter-clockwise from outside
    std::size_t material = 0;
};

// The bytes of a .glb: equal for equal input. load_gltf_level reads from it what was given, surface
// by surface, bit for bit. Throws PreconditionError for a surface without triangles or with an
// index or a material that is not there.
std::string write_glb(std::span<const GltfMaterial> materials,
                      std::span<const GltfSurface> surfaces);

}  // namespace handhold

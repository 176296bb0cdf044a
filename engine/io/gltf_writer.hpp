#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

// Writes geometry as glTF 2.0. Source: Khronos glTF 2.0 specification, sections 3.5 to 3.9 and 4;
// KHR_materials_emissive_strength for emissive factors above 1.
namespace handhold {

struct GltfMaterial {
    std::string name;
    std::array<float, 3> color = {0.5F, 0.5F, 0.5F};  // linear RGB in [0, 1]
    float emissive = 0.0F;                            // multiple of the colour, >= 0
    float opacity = 1.0F;                             // [0, 1]
    float gloss = 0.25F;                              // [0, 1]: 1 - roughness
};

struct GltfVertex {
    std::array<float, 3> position = {};
    std::array<float, 3> normal = {};  // unit
};

// One mesh with one material, and its node.
struct GltfSurface {
    std::string group;  // name of the parent node, which consecutive surfaces share
    std::string name;
    std::vector<GltfVertex> vertices;
    std::vector<std::uint32_t> indices;  // three per triangle, counter-clockwise seen from outside
    std::size_t material = 0;
};

// The bytes of a .glb. Equal input gives equal bytes. load_gltf_level reads the input back bit for
// bit, one part per surface. Throws PreconditionError for a surface without triangles and for an
// index or a material out of range.
std::string write_glb(std::span<const GltfMaterial> materials,
                      std::span<const GltfSurface> surfaces);

}  // namespace handhold

#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/io/gltf_skin.hpp"
#include "engine/io/gltf_writer.hpp"

// Meshes on skeletons into glTF 2.0. Source: Khronos glTF 2.0 specification, section 3.7.3.
namespace handhold {

// Of one material.
struct GltfSkinSurface {
    std::vector<GltfVertex> vertices;
    std::vector<SkinWeights> weights;  // by vertex
    std::vector<std::uint32_t> indices;
    std::size_t material = 0;
};

struct GltfSkin {
    std::string name;
    std::vector<SkinJoint> joints;  // parents before children
    std::vector<GltfSkinSurface> surfaces;
};

// Something rigid beside a skin: a node of that name with a mesh a surface below it; without
// surfaces an empty node. Its vertices are in its own frame.
struct GltfObject {
    std::string name;
    Pose pose_ms;
    std::vector<GltfSurface> surfaces;
};

// The bytes of a .glb in which the joints stand in their bind pose: equal for equal input.
// load_gltf_skin reads from it what was given, joints to within rounding to float. Throws
// PreconditionError for a skin without joints or surfaces, a surface without triangles, and an
// index, a joint, a parent or a material that is not there.
std::string write_skinned_glb(std::span<const GltfMaterial> materials, const GltfSkin& skin,
                              std::span<const GltfObject> objects = {});

}  // namespace handhold

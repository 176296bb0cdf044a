#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "engine/io/gltf_skin.hpp"
#include "engine/io/gltf_writer.hpp"

// Writes skinned meshes as glTF 2.0. Source: Khronos glTF 2.0 specification, section 3.7.3.
namespace handhold {

// The triangles of a skin that have one material.
struct GltfSkinSurface {
    std::vector<GltfVertex> vertices;
    std::vector<SkinWeights> weights;  // one per vertex
    std::vector<std::uint32_t> indices;
    std::size_t material = 0;
};

struct GltfSkin {
    std::string name;
    std::vector<SkinJoint> joints;  // parents before children
    std::vector<GltfSkinSurface> surfaces;
};

// A rigid object besides the skin: a node with one child per surface. An object without surfaces is
// an empty node.
struct GltfObject {
    std::string name;
    Pose pose_ms;
    std::vector<GltfSurface> surfaces = {};                   // vertices are in the object's frame
    std::map<std::string, std::vector<double>> numbers = {};  // extras of the node
};

// The bytes of a .glb whose joints are in their bind pose. Equal input gives equal bytes.
// load_gltf_skin reads the input back; joints are rounded to float. Throws PreconditionError for a
// skin without joints or surfaces, a surface without triangles, and an index, joint, parent or
// material out of range.
std::string write_skinned_glb(std::span<const GltfMaterial> materials, const GltfSkin& skin,
                              std::span<const GltfObject> objects = {});

}  // namespace handhold

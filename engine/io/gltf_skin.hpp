#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "engine/anim/skinning.hpp"
#include "engine/core/result.hpp"
#include "engine/io/gltf.hpp"
#include "engine/math/math.hpp"

// Reads a mesh and its skeleton from glTF 2.0. Source: Khronos glTF 2.0 specification, section
// 3.7.3.
namespace handhold {

struct SkinJoint {
    std::string name;          // name of the joint's node; may be empty
    std::int32_t parent = -1;  // index of the nearest joint above it; -1: none
    Pose bind_ms;              // pose in which the mesh was bound, without scale
    // Extras of the joint's node that are numbers or arrays of numbers.
    std::map<std::string, std::vector<double>> numbers = {};
};

// A mesh and its joints in the frame of the file's scene (_ms), metres, in the pose in which the
// mesh was bound: that of the skin's inverse bind matrices, whatever pose the file's nodes have.
// Without a skin it is the nodes' pose.
struct SkinnedMesh {
    std::string file;  // used in messages
    std::vector<Vec3> positions;
    std::vector<Vec3> normals;                            // one per vertex, unit length
    std::vector<SkinWeights> weights;                     // one per vertex
    std::vector<std::array<std::uint32_t, 3>> triangles;  // counter-clockwise seen from outside
    std::vector<ColorRun> color_runs;                     // never empty
    std::vector<SkinJoint> joints;
    std::vector<std::string> notes = {};  // what was ignored or changed; see GltfLevel::notes
};

constexpr std::size_t k_max_skin_joints = 1024;

// Loads the skin of the default scene and all meshes bound to it. Meshes without a skin are
// ignored. Vertices without a normal get one from their triangles. A vertex with more than four
// joints keeps the four heaviest; weights are scaled to a sum of 1. A vertex whose weights are all
// zero follows the first joint of its skin.
//
// Errors, with the JSON pointer of the cause: load_gltf_level's errors about geometry; no skin or
// more than one; joints that are not nodes of the scene, are listed twice, or are scaled unevenly
// or sheared; weights that are negative or not finite. A joint may be mirrored if its scale is
// otherwise even: bind_ms then keeps the direction of its Y axis, and is turned about it towards
// its Z axis.
Result<SkinnedMesh> load_gltf_skin(const std::filesystem::path& path);
// Reads from memory. `path` is used in messages and gives the folder of external buffers.
Result<SkinnedMesh> parse_gltf_skin(std::string_view bytes, const std::filesystem::path& path);

// Loads a whole figure: every node of the default scene becomes a joint. Meshes without a skin
// follow their node rigidly, and there may be several skins. Joints may also be scaled unevenly or
// sheared: bind_ms is then found as for mirrored joints. More than k_max_skin_joints nodes are an
// error. All other rules and errors are those of load_gltf_skin.
Result<SkinnedMesh> load_gltf_figure(const std::filesystem::path& path);
Result<SkinnedMesh> parse_gltf_figure(std::string_view bytes, const std::filesystem::path& path);

}  // namespace handhold

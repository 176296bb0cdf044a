#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "engine/anim/skinning.hpp"
#include "engine/io/gltf.hpp"
#include "engine/io/result.hpp"
#include "engine/math/math.hpp"

// A mesh on a skeleton out of glTF 2.0. Source: Khronos glTF 2.0 specification, section 3.7.3.
namespace handhold {

struct SkinJoint {
    std::string name;  // of its node; may be empty
    // Nearest joint above it, into SkinnedMesh::joints; files may be flat.
    std::int32_t parent = -1;
    Pose bind_ms;  // where it stands in the file, without its scale
    // Of its node's extras, those that are a number or an array of numbers.
    std::map<std::string, std::vector<double>> numbers = {};
};

// All in the frame of the file's scene (_ms), metres, as it stands there: posed by its nodes, which
// is the bind pose in all but strange files.
struct SkinnedMesh {
    std::string file;  // for messages
    std::vector<Vec3> positions;
    std::vector<Vec3> normals;                            // by vertex, unit
    std::vector<SkinWeights> weights;                     // by vertex
    std::vector<std::array<std::uint32_t, 3>> triangles;  // counter-clockwise from outside
    std::vector<ColorRun> color_runs;                     // at least one
    std::vector<SkinJoint> joints;
};

constexpr std::size_t k_max_skin_joints = 1024;

// Loads the skin of the default scene and all meshes on it; meshes without a skin are left out.
// Where a file has no normals, or some of no length, they are made from the triangles.
//
// Refused, with the JSON pointer of the culprit and nothing loaded: what load_gltf_level refuses;
// no skin or more than one; joints that are no nodes of the scene, twice the same, squashed or
// mirrored; weights that are negative, not finite or all zero; more than four joints a vertex.
Result<SkinnedMesh> load_gltf_skin(const std::filesystem::path& path);
// The same for bytes in memory; `path` is for messages and for external buffers.
Result<SkinnedMesh> parse_gltf_skin(std::string_view bytes, const std::filesystem::path& path);

// A figure: every node of the default scene is a joint, carrying what hangs on it; meshes without
// a skin go with their node as a whole, skins may be several. Otherwise as above, but that joints
// may be squashed and mirrored too: then bind_ms keeps the way their Y goes and turns about it as Z
// does. Refused besides: more than k_max_skin_joints nodes.
Result<SkinnedMesh> load_gltf_figure(const std::filesystem::path& path);
Result<SkinnedMesh> parse_gltf_figure(std::string_view bytes, const std::filesystem::path& path);

}  // namespace handhold

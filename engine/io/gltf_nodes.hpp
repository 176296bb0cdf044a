#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/io/result.hpp"
#include "engine/math/math.hpp"

// Reads the node hierarchy of a glTF 2.0 file without its meshes.
namespace handhold {

struct GltfNode {
    std::string name;             // may be empty
    std::optional<Pose> pose_ms;  // in the scene's frame, without scale; absent if the node is
                                  // scaled unevenly, sheared or mirrored
    std::map<std::string, std::vector<double>> numbers;  // extras that are numbers, or arrays of
                                                         // numbers
    std::string pointer;                                 // JSON pointer: "/nodes/3"
    std::optional<std::size_t> parent;                   // index in the list; absent for a root
};

// The nodes of the default scene; without one, of the first scene; without scenes, all. Parents
// come before children. Refuses what load_gltf_level refuses about nodes; skins are not read.
Result<std::vector<GltfNode>> load_gltf_nodes(const std::filesystem::path& path);
// Reads from memory. `path` is for messages.
Result<std::vector<GltfNode>> parse_gltf_nodes(std::string_view bytes,
                                               const std::filesystem::path& path);

}  // namespace handhold

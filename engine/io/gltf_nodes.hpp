#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/result.hpp"
#include "engine/math/math.hpp"

// Reads the node hierarchy of a glTF 2.0 file without its meshes.
namespace handhold {

struct GltfNode {
    std::string name;  // may be empty
    // In the scene's frame, without scale. nullopt if the node is scaled unevenly, sheared or
    // mirrored.
    std::optional<Pose> pose_ms;
    // Extras that are numbers or arrays of numbers.
    std::map<std::string, std::vector<double>> numbers;
    std::string pointer;                // JSON pointer: "/nodes/3"
    std::optional<std::size_t> parent;  // index in the list; nullopt for a root
};

// The nodes of the default scene; if there is none, of the first scene; if there are no scenes, all
// nodes. Parents come before children. Has load_gltf_level's errors about nodes; does not read
// skins.
Result<std::vector<GltfNode>> load_gltf_nodes(const std::filesystem::path& path);
// Reads from memory. `path` is used in messages.
Result<std::vector<GltfNode>> parse_gltf_nodes(std::string_view bytes,
                                               const std::filesystem::path& path);

}  // namespace handhold

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

// How the nodes of a glTF 2.0 file stand, without their meshes: what an animation package has
// posed.
namespace handhold {

struct GltfNode {
    std::string name;             // may be empty
    std::optional<Pose> pose_ms;  // in the frame of the file's scene, without its scale; none of
                                  // one that is squashed or mirrored
    std::map<std::string, std::vector<double>> numbers;  // of its extras
    std::string pointer;                                 // "/nodes/3"
    std::optional<std::size_t> parent;                   // its place in the list; none of a root
};

// The nodes of the default scene (else of the first one, else all), parents before children.
// Refused: what load_gltf_skin refuses, but for skins.
Result<std::vector<GltfNode>> load_gltf_nodes(const std::filesystem::path& path);
// The same for bytes in memory; `path` is for messages and for external buffers.
Result<std::vector<GltfNode>> parse_gltf_nodes(std::string_view bytes,
                                               const std::filesystem::path& path);

}  // namespace handhold

#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/io/gltf.hpp"
#include "game/levels/station.hpp"
#include "game/levels/station_description.hpp"
#include "game/scene/scene_file.hpp"

namespace handhold {

// A mesh file that a station's scene names, in memory.
struct StationModel {
    std::filesystem::path file;  // relative to the scene file
    Structure structure;
};

// A station as a scene file and its models. The scene is the same whether it is built in memory, or
// written and loaded again: same names, triangles and state hashes.
struct StationScene {
    SceneFile scene;
    std::vector<StationModel> models;
};
StationScene make_station_scene(const StationDescription& description);

// The level that load_gltf_level would read from the file of write_model_glb, except that triangles
// share vertices.
GltfLevel level_of(const Structure& structure);
// A .glb with a node for each part below a node for each section, with normals and materials.
std::string write_model_glb(const Structure& structure);

// Writes `folder`/<scene's name>.json and its models. Returns the reason for a failure.
std::optional<FileError> write_station(const StationScene& station,
                                       const std::filesystem::path& folder);

}  // namespace handhold

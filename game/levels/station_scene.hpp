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

// A mesh file that a scene of a station names, before it is written.
struct StationModel {
    std::filesystem::path file;  // relative to the scene's
    Structure structure;
};

// What a description becomes: a scene file and the models that it names. Built in memory or written
// and loaded again, it is the same scene: same names, same triangles, same state hashes.
struct StationScene {
    SceneFile scene;
    std::vector<StationModel> models;
};
StationScene make_station_scene(const StationDescription& description);

// As load_gltf_level reads it from the file that write_model_glb makes, but for vertices that are
// shared.
GltfLevel level_of(const Structure& structure);
// A .glb of it: a node a part below one a section, with normals and materials.
std::string write_model_glb(const Structure& structure);

// Writes `folder`/<scene's name>.json and its models. The reason where that failed.
std::optional<FileError> write_station(const StationScene& station,
                                       const std::filesystem::path& folder);

}  // namespace handhold

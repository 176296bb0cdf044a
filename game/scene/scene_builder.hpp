#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "engine/core/result.hpp"
#include "engine/geometry/mesh.hpp"
#include "game/scene/scene.hpp"
#include "game/scene/scene_file.hpp"

namespace handhold {

// Adds a scene file's levels, bodies, joints, lamps, spawns and players to a scene whose tuning and
// head shape are set. Stops at the first error and returns it. `path`: the file, for error
// messages.
std::optional<FileError> add_scene_parts(const SceneFile& file, const std::filesystem::path& path,
                                         const LevelSource& levels, Scene& scene);

// A static body without a visual.
Entity add_static_body(Scene& scene, const std::string& name, std::shared_ptr<const Mesh> mesh,
                       const Pose& pose_ws);

}  // namespace handhold

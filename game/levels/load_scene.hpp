#pragma once

#include <string>

#include "engine/core/result.hpp"
#include "game/scene/scene.hpp"

namespace handhold {

// Loads a built-in scene by name, a scene file (.json), or a level (.glb, .gltf: each mesh node
// becomes a static body). Loads all or nothing.
Result<Scene> load_scene(const std::string& name_or_file);

}  // namespace handhold

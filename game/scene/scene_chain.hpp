#pragma once

#include <string>

#include "engine/io/json.hpp"
#include "game/scene/scene_file.hpp"

namespace handhold {

// Reads a chain from a scene's JSON (docs/reference/scene_format.md, "Chains") and appends its
// parts to the scene: capsules "<name>/0", ... and ball joints "<name>/joint/0", ...
void read_scene_chain(const JsonValue& value, const std::string& name, SceneJointNames& names,
                      SceneFile& scene);

}  // namespace handhold

#pragma once

#include <string>

#include "engine/io/json.hpp"
#include "game/scene/scene_file.hpp"

namespace handhold {

// A chain of a scene's JSON (docs/reference/scene_format.md, "Chains") as what it is made of:
// capsules
// "<name>/0", ... and ball joints "<name>/joint/0", ..., appended to the scene's bodies and joints.
void read_scene_chain(const JsonValue& value, const std::string& name, SceneJointNames& names,
                      SceneFile& scene);

}  // namespace handhold

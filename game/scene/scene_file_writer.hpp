#pragma once

#include <string>

#include "game/scene/scene_file.hpp"

namespace handhold {

// The scene as JSON (docs/reference/scene_format.md). parse_scene_file reads the same numbers back,
// except for the last digit of joints' angles. Paths are written unchanged.
std::string write_scene_file(const SceneFile& scene);

}  // namespace handhold

#pragma once

#include <string>

#include "game/scene/scene_file.hpp"

namespace handhold {

// The JSON of a scene, as docs/reference/scene_format.md says; parse_scene_file reads from it what
// was given, number for number, but for the last digit of joints' angles. Paths are written as they
// are.
std::string write_scene_file(const SceneFile& scene);

}  // namespace handhold

#pragma once

#include <string>

#include "game/scene/scene.hpp"

namespace handhold {

// load_scene on all of the machine's threads, with a progress bar on a terminal. The number of
// threads is afterwards as it was.
Result<Scene> load_scene_with_progress(const std::string& name_or_file);

}  // namespace handhold

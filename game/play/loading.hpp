#pragma once

#include <string>

#include "game/scene/scene.hpp"

namespace handhold {

// Calls load_scene with all of the machine's threads. Shows a progress bar if standard error is a
// terminal. Afterwards restores the number of threads. Keeps finished grip meshes in the user's
// cache folder ($XDG_CACHE_HOME/handhold or ~/.cache/handhold), so that the next start is faster.
Result<Scene> load_scene_with_progress(const std::string& name_or_file);

}  // namespace handhold

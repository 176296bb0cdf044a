#pragma once

#include "game/scene/scene.hpp"

namespace handhold {

// Turns a scene into the crowd: things float about in its free space, small jets for all, and a
// dozen climbers beside whoever plays. The first spawn's surroundings stay as they are.
void fill_with_crowd(Scene& scene);

}  // namespace handhold

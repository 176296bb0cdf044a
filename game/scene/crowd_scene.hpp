#pragma once

#include "game/scene/scene.hpp"

namespace handhold {

// Turns a scene into the crowd: free bodies float in its open space, all players have small jets,
// and a dozen climbers accompany the first player. The surroundings of the first spawn stay as they
// are.
void fill_with_crowd(Scene& scene);

}  // namespace handhold

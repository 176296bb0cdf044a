#pragma once

#include "game/scene/scene.hpp"

namespace handhold {

// Turns a scene into the crowd scene: adds free bodies in open space, weak jets for all players,
// and a dozen climbers in addition to the first player. Adds no bodies near the first spawn.
void fill_with_crowd(Scene& scene);

}  // namespace handhold

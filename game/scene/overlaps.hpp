#pragma once

#include <string>
#include <vector>

#include "game/scene/scene.hpp"

namespace handhold {

// Two bodies, or a player's head and another collider, that overlap at the start. The first frames
// would push them apart.
struct SpawnOverlap {
    std::string a;
    std::string b;
    double depth_m = 0.0;
};

// Finds the overlaps deeper than 5 mm before the first frame, between bodies and with the heads of
// `players`, who stand upright. The deepest comes first. Ignores bodies that a joint connects.
std::vector<SpawnOverlap> find_overlaps(Scene& scene, const std::vector<PlayerEntities>& players);

}  // namespace handhold

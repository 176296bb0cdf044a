#pragma once

#include <string>
#include <vector>

#include "game/scene/scene.hpp"
#include "systems/frame.hpp"

namespace handhold {

// Two bodies, or a player's head and something else, that begin inside each other: the first frames
// push them apart.
struct SpawnOverlap {
    std::string a;
    std::string b;
    double depth_m = 0.0;
};

// Overlaps deeper than 5 mm of free bodies and of the heads of `players`, who stand upright, before
// the first frame; deepest first. Bodies that a joint ties together are left out. `caches` belong
// to the scene.
std::vector<SpawnOverlap> find_overlaps(const Scene& scene, FrameCaches& caches,
                                        const std::vector<PlayerEntities>& players);

}  // namespace handhold

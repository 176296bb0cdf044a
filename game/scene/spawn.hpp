#pragma once

#include <string>

#include "game/scene/scene.hpp"
#include "game/session/recording.hpp"
#include "systems/frame.hpp"

namespace handhold {

struct FoundSpawn {
    Pose origin_ws;
    std::size_t onsets = 0;   // grabs in the recording
    std::size_t gripped = 0;  // grabs that grip when the session is played from here
};

// Finds the standing place and yaw from which most of the recording's grabs begin near a surface,
// with the head clear. Candidates put one of the recording's first grabs onto a random point of the
// scene's surfaces. They are evaluated along the path that the origin would take if every grab
// gripped; the best are played. Deterministic. Up is the scene's. `caches` belong to the scene. A
// scene without surfaces gives its first spawn, or the origin.
FoundSpawn find_spawn(const Scene& scene, FrameCaches& caches, const Recording& recording,
                      double hz);

}  // namespace handhold

#pragma once

#include <string>

#include "game/scene/scene.hpp"
#include "game/session/recording.hpp"
#include "systems/frame.hpp"

namespace handhold {

struct FoundSpawn {
    Pose origin_ws;
    std::size_t onsets = 0;   // grabs in the recording
    std::size_t gripped = 0;  // of them that grip when the session is played from here
};

// The standing place and yaw in a scene from which most of the recording's grabs begin near a
// surface, with the head clear of everything. Places are proposed by laying the recording's first
// grabs onto points of the scene's surfaces, judged by the path that the origin would take if every
// grab gripped, and the best are played. Deterministic; up is the scene's. `caches` belong to the
// scene. A scene without surfaces gives its first spawn, or the origin.
FoundSpawn find_spawn(const Scene& scene, FrameCaches& caches, const Recording& recording,
                      double hz);

}  // namespace handhold

#pragma once

#include <cstddef>

#include <handhold/handhold.hpp>

#include "game/scene/scene.hpp"
#include "game/session/recording.hpp"

namespace handhold {

struct FoundSpawn {
    hh::Pose origin_ws = hh::k_origin;
    std::size_t onsets = 0;   // grabs in the recording
    std::size_t gripped = 0;  // grabs that grip when the session is played from here
};

// Finds the start place and yaw from which most of the recording's grabs begin with the palm
// towards a near surface that the player sees, with the head clear of surfaces. Assumes
// that the recorded player's palm faced what it took hold of. Each candidate puts one of the
// recording's first grabs before a random point of the scene's surfaces, on the side to which the
// triangle is wound, and the head on the same side. Candidates are rated along the path that the
// origin would take if every grab gripped. The best ones are played: the largest sum of rating and
// grips wins, then the longest path. Deterministic. The player stands along the scene's up
// direction. Without such a place, returns the first spawn, or the world's origin. Afterwards the
// scene's world is as it was.
FoundSpawn find_spawn(Scene& scene, const Recording& recording, double hz);

}  // namespace handhold

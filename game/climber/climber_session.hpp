#pragma once

#include <cstdint>
#include <vector>

#include "game/climber/climber.hpp"
#include "game/session/recording.hpp"

namespace handhold {

// The session of a single climber, to be recorded.
struct ClimbPlan {
    hh::Pose origin_ws = hh::k_origin;
    std::vector<ClimberWaypoint> waypoints;  // empty: wanders
    double seconds = 20.0;  // maximum; the session ends linger_s after the last waypoint is reached
    double linger_s = 1.5;
    double cruise_mps = 0.6;
    bool may_leap = true;
    bool single_hand = false;
    std::uint64_t seed = 1;
};

// Plays the climb and returns what a headset would record. Precondition: the scene has not been
// stepped. Adds a player "player0", disables jets, and steps the scene at 90 Hz. Playing the
// recording from the same place at 90 Hz repeats the session bit for bit.
Recording record_climb(Scene& scene, const ClimbPlan& plan);

}  // namespace handhold

#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "game/climber/climber.hpp"
#include "game/session/recording.hpp"

namespace handhold {

// A single climber whose session is recorded.
struct ClimbPlan {
    Pose origin_ws;
    std::vector<ClimberWaypoint> waypoints;  // empty: wanders
    double seconds = 20.0;  // at most; ends linger_s after the last waypoint is reached
    double linger_s = 1.5;
    double cruise_mps = 0.6;
    bool may_leap = true;
    bool single_hand = false;
    std::uint64_t seed = 1;
};

// The climber's session as a headset would record it. The scene must be before its first frame; it
// is stepped at 90 Hz, with a player "player0" and without jets. Playing the recording from the
// same place at 90 Hz repeats it bit for bit.
Recording record_climb(Scene& scene, const ClimbPlan& plan);

// `handhold climb`: its command line.
struct ClimbOptions {
    std::string scene;
    std::string spawn;  // empty: the scene's first
    std::string out;    // the recording
    double seconds = 20.0;
    std::uint64_t seed = 1;
};
// Records a wandering climber. Returns the exit status: 0; k_exit_bad_file after one line on
// standard error if a file is refused or cannot be written; k_exit_interrupted after a signal, with
// what was recorded so far.
int climb_command(const ClimbOptions& options);

}  // namespace handhold

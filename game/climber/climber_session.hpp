#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "game/climber/climber.hpp"
#include "game/session/recording.hpp"

namespace handhold {

// Who climbs alone in a scene, to be recorded.
struct ClimbPlan {
    Pose origin_ws;
    std::vector<ClimberWaypoint> waypoints;  // empty: he wanders
    double seconds = 20.0;                   // at most; less where he has been at the last waypoint
                                             // for linger_s
    double linger_s = 1.5;
    double cruise_mps = 0.6;
    bool may_leap = true;
    bool single_hand = false;
    std::uint64_t seed = 1;
};

// What his headset says: a session like one that a person recorded. The scene must be as it is
// before its first frame; it is stepped on at 90 Hz to where he ends, with a player named "player0"
// and without jets, so that playing the recording from the same place at 90 Hz repeats every bit.
Recording record_climb(Scene& scene, const ClimbPlan& plan);

// `handhold climb`, as given on the command line.
struct ClimbOptions {
    std::string scene;
    std::string spawn;  // empty: the scene's first
    std::string out;    // the recording
    double seconds = 20.0;
    std::uint64_t seed = 1;
};
// Records a climber who wanders. Returns the exit status: 0, or 2 after one line on standard error
// where a file is refused or cannot be written.
int climb_command(const ClimbOptions& options);

}  // namespace handhold

#pragma once

#include <vector>

#include "components/tracking.hpp"
#include "components/tuning.hpp"
#include "game/session/recording.hpp"

// Sessions that ship with the game: what a headset would have recorded of someone who climbs as
// planned. The plan is made in the world (or in the ship's frame); since a gripping hand moves the
// head 1:1, hands in play space follow from it.
namespace handhold {

// A hand on a bar or a surface.
struct ScriptedHold {
    HandSide side = HandSide::left;
    double from_s = 0.0;
    double until_s = 0.0;
    Vec3 palm = Vec3::Zero();       // where the palm's skin goes
    Vec3 away = Vec3::UnitY();      // unit, from what is gripped into the palm
    Vec3 fingers = -Vec3::UnitZ();  // unit, across `away`
};

// Where the eyes are meant to be. Between two keys: a cubic with the keys' velocities; equal
// velocities along the line between them give straight, even flight.
struct ScriptedBody {
    double t_s = 0.0;
    Vec3 eyes = Vec3::Zero();
    Vec3 velocity_mps = Vec3::Zero();
};

// Free motion of a hand, given by the place of its palm: it passes through these between its holds.
struct ScriptedReach {
    HandSide side = HandSide::left;
    double t_s = 0.0;
    Vec3 palm = Vec3::Zero();
    Vec3 away = Vec3::UnitY();
    Vec3 fingers = -Vec3::UnitZ();
};

struct SessionScript {
    Quat play_space = Quat::Identity();  // of the play space in the plan's frame
    double eye_height_m = 1.6;  // eyes over the play space's floor point when the session begins
    double duration_s = 0.0;
    std::vector<ScriptedBody> body;   // by time, first at 0
    std::vector<ScriptedHold> holds;  // by time for each hand, not overlapping
    std::vector<ScriptedReach> reaches;
};

// Adds alternating holds along a bar, for a body that moves along it at `speed_mps` from its key at
// from_s until until_s.
struct ScriptedCrawl {
    Vec3 bar_start = Vec3::Zero();  // any point of the bar's axis
    Vec3 along = Vec3::UnitX();     // unit, the way the body goes
    Vec3 away = Vec3::UnitY();
    Vec3 fingers = Vec3::UnitY();
    double palm_off_axis_m = 0.02;  // bar's radius and a little
    double speed_mps = 0.5;
    double from_s = 0.0;
    double until_s = 1.0;
};
void add_crawl(const ScriptedCrawl& crawl, SessionScript& script);

// The play space at the session's beginning, in the plan's frame.
Pose session_origin(const SessionScript& script);
// 90 samples a second with the small tremor of a living hand.
Recording record_session(const SessionScript& script, const HandTuning& tuning);

}  // namespace handhold

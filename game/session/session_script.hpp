#pragma once

#include <vector>

#include "components/tracking.hpp"
#include "components/tuning.hpp"
#include "game/session/recording.hpp"

// The game's sessions: recordings of a planned climb as a headset would make them. The plan is in
// the world (or in the ship's frame). A gripping hand moves the head 1:1, so the hands in play
// space follow from the plan.
namespace handhold {

// A hand on a bar or a surface.
struct ScriptedHold {
    HandSide side = HandSide::left;
    double from_s = 0.0;
    double until_s = 0.0;
    Vec3 palm = Vec3::Zero();       // where the palm's skin is
    Vec3 away = Vec3::UnitY();      // unit, from the surface into the palm
    Vec3 fingers = -Vec3::UnitZ();  // unit, across `away`
};

// Planned positions of the eyes. Between two keys: a cubic with the keys' velocities. Equal
// velocities along the line between two keys give uniform motion.
struct ScriptedBody {
    double t_s = 0.0;
    Vec3 eyes = Vec3::Zero();
    Vec3 velocity_mps = Vec3::Zero();
};

// Free motion of a hand between its holds, through this place of the palm.
struct ScriptedReach {
    HandSide side = HandSide::left;
    double t_s = 0.0;
    Vec3 palm = Vec3::Zero();
    Vec3 away = Vec3::UnitY();
    Vec3 fingers = -Vec3::UnitZ();
};

struct SessionScript {
    Quat play_space = Quat::Identity();  // of the play space in the plan's frame
    double eye_height_m = 1.6;           // eyes above the play space's floor point at the start
    double duration_s = 0.0;
    std::vector<ScriptedBody> body;   // by time, first at 0
    std::vector<ScriptedHold> holds;  // by time for each hand, not overlapping
    std::vector<ScriptedReach> reaches;
};

// Adds alternating holds along a bar for a body that moves along it at `speed_mps`, from the body's
// key at from_s until until_s.
struct ScriptedCrawl {
    Vec3 bar_start = Vec3::Zero();  // any point of the bar's axis
    Vec3 along = Vec3::UnitX();     // unit, the body's direction
    Vec3 away = Vec3::UnitY();
    Vec3 fingers = Vec3::UnitY();
    double palm_off_axis_m = 0.02;  // the bar's radius and a little
    double speed_mps = 0.5;
    double from_s = 0.0;
    double until_s = 1.0;
};
void add_crawl(const ScriptedCrawl& crawl, SessionScript& script);

// The play space at the start, in the plan's frame.
Pose session_origin(const SessionScript& script);
// 90 samples a second with a hand's natural tremor.
Recording record_session(const SessionScript& script, const HandTuning& tuning);

}  // namespace handhold

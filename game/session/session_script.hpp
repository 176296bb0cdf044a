#pragma once

#include <vector>

#include <handhold/handhold.hpp>
#include <handhold/math.hpp>

#include "game/session/hand_pose.hpp"
#include "game/session/recording.hpp"

// The game's built-in sessions: recordings of planned climbs, as a headset would make them. A plan
// is in the world's frame or in a ship's. A gripping hand moves the head 1:1, so the hands' motion
// in play space follows from the plan.
namespace handhold {

// A hand on a bar or a surface.
struct ScriptedHold {
    hh::Side side = HH_LEFT;
    double from_s = 0.0;
    double until_s = 0.0;
    hh::Vec3 palm = hh::Vec3{};   // point of the palm's skin that touches
    hh::Vec3 away = hh::k_y;      // unit, from the surface into the palm
    hh::Vec3 fingers = -hh::k_z;  // unit, across `away`
};

// A planned position of the eyes. Between two of them: a cubic with the velocities of both. If both
// velocities point along the line between the positions and are equal, the motion is uniform.
struct ScriptedBody {
    double t_s = 0.0;
    hh::Vec3 eyes = hh::Vec3{};
    hh::Vec3 velocity_mps = hh::Vec3{};
};

// A hand passes this pose at `t_s`, between its holds or while it holds a free body.
struct ScriptedReach {
    hh::Side side = HH_LEFT;
    double t_s = 0.0;
    hh::Vec3 palm = hh::Vec3{};
    hh::Vec3 away = hh::k_y;
    hh::Vec3 fingers = -hh::k_z;
};

// The index finger presses its trigger down within 0.15 s from `from_s` on and releases it within
// 0.15 s before `until_s`.
struct ScriptedPress {
    hh::Side side = HH_LEFT;
    double from_s = 0.0;
    double until_s = 0.0;  // 0.3 s later or more
};

struct SessionScript {
    hh::Quat play_space = hh::k_no_turn;  // rotation of the play space in the plan's frame
    // Height of the eyes above the play space's floor point at the start.
    double eye_height_m = 1.6;
    double duration_s = 0.0;
    std::vector<ScriptedBody> body;   // indexed by time, first at 0
    std::vector<ScriptedHold> holds;  // sorted by time for each hand, not overlapping
    std::vector<ScriptedReach> reaches;
    std::vector<ScriptedPress> presses;  // not overlapping
};

// A body that moves along a bar, hand over hand. add_crawl adds alternating holds from `from_s`
// until `until_s`; the keys of SessionScript::body must already contain the body's motion.
struct ScriptedCrawl {
    hh::Vec3 bar_start = hh::Vec3{};  // any point of the bar's axis
    hh::Vec3 along = hh::k_x;         // unit, along the bar in the direction of travel
    hh::Vec3 away = hh::k_y;
    hh::Vec3 fingers = hh::k_y;
    double palm_off_axis_m = 0.02;  // slightly more than the bar's radius
    double from_s = 0.0;
    double until_s = 1.0;
};
void add_crawl(const ScriptedCrawl& crawl, SessionScript& script);

// The play space at the start, in the plan's frame.
hh::Pose session_origin(const SessionScript& script);
// Records the plan with 90 samples a second and a hand's natural tremor.
Recording record_session(const SessionScript& script, const HandShape& shape);

}  // namespace handhold

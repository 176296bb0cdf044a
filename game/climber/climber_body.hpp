#pragma once

#include "game/climber/climber.hpp"

// Movements of a climber's head and hands between two decisions, and the tracking samples that a
// headset would report.
namespace handhold {

// What the climber perceives at the start of a frame.
struct ClimberMoment {
    double t_s = 0.0;
    hh::Pose origin_ws = hh::k_origin;
    hh::Vec3 origin_mps = hh::Vec3{};    // velocity of the play space in the world
    hh::Vec3 head_ws = hh::Vec3{};       // centre of the head's collider
    hh::Vec3 support_mps = hh::Vec3{};   // velocity of the current or last support, at the hand
    hh::Vec3 relative_mps = hh::Vec3{};  // velocity of the play space relative to the support
    bool carried = false;                // whether a hand holds a support
};
ClimberMoment sense(const hh::World& world, const ClimberTask& task, const ClimberState& state);

inline constexpr double k_climber_arm_m = 0.72;  // longest distance from shoulder to wrist
hh::Vec3 shoulder_ps(const ClimberState& state, hh::Side side);
// Duration of a reach over a distance, [0.3, 0.8] s.
double reach_time_s(double distance_m);

// The pose of a body at `t_s`, extrapolated at constant velocity. A null or destroyed body gives
// the identity.
hh::Pose body_at(const hh::World& world, hh::Body body, const ClimberMoment& now, double t_s);
// The velocity of a body at `point_ws`; zero for a null or destroyed body.
hh::Vec3 velocity_at(const hh::World& world, hh::Body body, const hh::Vec3& point_ws);

// Moves eyes and hands to the rest pose at the time of the newest sample.
void place_body(ClimberState& state);

// These functions start a movement at the time of the newest sample.
void begin_reach(const ClimberHold& hold, double seconds, ClimberState& state, hh::Side side);
void begin_rest(ClimberState& state, hh::Side side);
// Precondition: the hand carries a body. It flies off along `along_ps` (unit).
void begin_throw(const hh::Vec3& along_ps, ClimberState& state, hh::Side side);
void let_go(ClimberState& state, hh::Side side);  // opens the hand and moves it to rest

// The time of the next sample: the next regular time, or an earlier time at which a reaching hand
// closes. Counts the sample if it is regular.
double next_sample_time(const ClimberTask& task, ClimberState& state);
// Moves head and hands from the newest sample's time to `t_s`.
void move_body(const hh::World& world, const ClimberMoment& now, double t_s, ClimberState& state);
// Head and controllers at `t_s` as a headset would report them, with hand tremor.
hh::Sample sample_body(const hh::World& world, const ClimberTask& task, double t_s,
                       const ClimberState& state);

}  // namespace handhold

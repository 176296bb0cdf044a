#pragma once

#include "components/world.hpp"
#include "game/climber/climber.hpp"

// Movements of a climber's head and hands between two decisions, and the tracking samples that a
// headset would report.
namespace handhold {

// What the climber perceives at the start of a frame.
struct ClimberMoment {
    double t_s = 0.0;
    Pose origin_ws;
    Vec3 origin_mps = Vec3::Zero();    // velocity of the play space in the world
    Vec3 head_ws = Vec3::Zero();       // centre of the head's collider
    Vec3 support_mps = Vec3::Zero();   // velocity of the current or last support, at the hand
    Vec3 relative_mps = Vec3::Zero();  // velocity of the play space relative to the support
    bool carried = false;              // whether a hand holds a support
};
ClimberMoment sense(const Scene& scene, const ClimberTask& task, const ClimberState& state);

inline constexpr double k_climber_arm_m = 0.72;  // longest distance from shoulder to wrist
Vec3 shoulder_ps(const ClimberState& state, HandSide side);
// Duration of a reach over a distance, [0.3, 0.8] s.
double reach_time_s(double distance_m);

// The pose of a body at `t_s`, extrapolated at constant velocity. A null or destroyed body gives
// the identity.
Pose body_at(const World& world, Entity body, const ClimberMoment& now, double t_s);
// The velocity of a body at `point_ws`; zero for a null or destroyed body.
Vec3 velocity_at(const World& world, Entity body, const Vec3& point_ws);

// Moves eyes and hands to the rest pose at the time of the newest sample.
void place_body(ClimberState& state);

// These functions start a movement at the time of the newest sample.
void begin_reach(const ClimberHold& hold, double seconds, ClimberState& state, HandSide side);
void begin_rest(ClimberState& state, HandSide side);
void let_go(ClimberState& state, HandSide side);  // opens the hand and moves it to rest

// The time of the next sample: the next regular time, or an earlier time at which a reaching hand
// closes. Counts the sample if it is regular.
double next_sample_time(const ClimberTask& task, ClimberState& state);
// Moves head and hands from the newest sample's time to `t_s`, at most some tens of milliseconds.
void move_body(const Scene& scene, const ClimberMoment& now, double t_s, ClimberState& state);
// Head and controllers at `t_s` as a headset would report them, with hand tremor.
TrackingSample sample_body(const Scene& scene, const ClimberTask& task, double t_s,
                           const ClimberState& state);

}  // namespace handhold

#pragma once

#include "components/world.hpp"
#include "game/climber/climber.hpp"

// What a climber's body can do: movements of head and hands between two decisions, and the samples
// that a headset makes of them.
namespace handhold {

// What he feels and sees at the start of a frame.
struct ClimberMoment {
    double t_s = 0.0;
    Pose origin_ws;
    Vec3 origin_mps = Vec3::Zero();    // of the play space in the world
    Vec3 head_ws = Vec3::Zero();       // centre of the head's collider
    Vec3 support_mps = Vec3::Zero();   // of what carries him or did last, at his hand
    Vec3 relative_mps = Vec3::Zero();  // of the play space against that
    bool carried = false;              // a hand holds something that carries him
};
ClimberMoment sense(const Scene& scene, const ClimberTask& task, const ClimberState& state);

inline constexpr double k_climber_arm_m = 0.72;  // wrist from shoulder at most
Vec3 shoulder_ps(const ClimberState& state, HandSide side);
// How long a hand takes over a distance, [0.3, 0.8] s.
double reach_time_s(double distance_m);

// Where a point of a body will be, seen that its motion is steady: at t_s, with the pose of the
// moment. A body that is gone stands still at the origin.
Pose body_at(const World& world, Entity body, const ClimberMoment& now, double t_s);
// Of a body's point; zero for null and for what is gone.
Vec3 velocity_at(const World& world, Entity body, const Vec3& point_ws);

// Stands at ease, at the time of the newest sample.
void place_body(ClimberState& state);

// Begin movements at the newest sample.
void begin_reach(const ClimberHold& hold, double seconds, ClimberState& state, HandSide side);
void begin_rest(ClimberState& state, HandSide side);
void let_go(ClimberState& state, HandSide side);  // opens the hand, on its way to rest

// The time of the next sample: a regular one, or that of a hand which arrives and closes before.
// Counts the regular ones.
double next_sample_time(const ClimberTask& task, ClimberState& state);
// Moves head and hands on from the newest sample to t_s, at most a few tens of milliseconds.
void move_body(const Scene& scene, const ClimberMoment& now, double t_s, ClimberState& state);
// What the headset says of where head and hands are.
TrackingSample sample_body(const Scene& scene, const ClimberTask& task, double t_s,
                           const ClimberState& state);

}  // namespace handhold

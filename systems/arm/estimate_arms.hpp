#pragma once

#include <array>

#include "components/arm.hpp"
#include "components/body_tuning.hpp"
#include "components/grab.hpp"
#include "components/hand.hpp"
#include "components/player.hpp"
#include "components/tracking.hpp"
#include "engine/ecs/column.hpp"

namespace handhold {

struct EstimateArmsIo {
    double dt_s = 0.0;                     // in: > 0
    const Column<PlayerOrigin>& origin;    // in
    const Column<HeadTracking>& head;      // in
    const Column<BodyMeasures>& measures;  // in: every player
    const Column<HandOwner>& owner;        // in
    const Column<PalmPose>& palm;          // in: shown hands
    Column<ArmMemory>& memory;             // in/out
    Column<ArmEstimate>& estimate;         // out
};

// Stage 12. Estimates every player's chest, shoulders and elbow directions from head and hands
// (talk rows 19 to 22). Works in play space, so that players may hang upside down or turn with a
// ship. If the head jumps, the state is re-initialised; if a hand jumps, that arm's state.
void estimate_arms(const EstimateArmsIo& io, const ArmTuning& tuning);

// The steps of estimate_arms for one player. A "level" direction is a horizontal unit vector.

// Level look direction of a head, from its forward axis `ahead` and its up axis. Beyond 45 degrees
// of pitch the up axis blends in (negated if the head looks up), because `ahead` becomes vertical.
Vec3 level_look(const Vec3& ahead, const Vec3& up);

// Gain dt / (dt + lag) of an implicit low-pass filter. The output lags a steady motion by lag_s at
// any frame rate.
inline double follow_share(double dt_s, double lag_s) { return dt_s / (dt_s + lag_s); }

// Turns `look_ps` towards `now_ps` by `share` of the angle. Both are level.
Vec3 follow_look(const Vec3& look_ps, const Vec3& now_ps, double share);

// Turns `facing_ps` towards `now_ps` by at most `most_rad`. Both are level.
Vec3 turn_at_most(const Vec3& facing_ps, const Vec3& now_ps, double most_rad);

// Lean of the chest: the rotation from the play space's up towards the head's up, by `share`.
Quat chest_lean(const Vec3& head_up_ps, double share);

// A hand relative to the eyes.
struct HandReach {
    Vec3 position;  // in arm lengths
    Vec3 back;      // unit, out of the back of the hand
};
// A maximum angle of at most half a turn, given by its sine and cosine.
struct TurnLimit {
    double sine = 0.0;
    double cosine = 1.0;
};
// Level direction in which the chest faces, from the look direction and the hands. The chest turns
// towards the mean position of the hands, turns perpendicular to the line between them, and follows
// rolling hands. `lean_ps`: chest_lean. `limit`: the maximum angle from the look direction.
Vec3 chest_facing(const Vec3& look_ps, const Quat& lean_ps,
                  const std::array<HandReach, k_hand_count>& hands_ps, const TurnLimit& limit,
                  const ArmTuning& tuning);

// Displacement of the shoulder by the clavicle's movement, metres. `hand`: position relative to the
// shoulder at rest, in torso axes and arm lengths.
Vec3 clavicle_shift(const Vec3& hand, const ArmTuning& tuning);

// Displacement of the shoulder towards a hand that the arm does not reach. `hand_m`: position
// relative to the shoulder.
Vec3 shoulder_follow(const Vec3& hand_m, double arm_m, const ArmTuning& tuning);

// Wanted direction of an elbow, in torso axes, not normalised: a regression on the hand's axes.
Vec3 elbow_pole(const Vec3& facing_ps, const Mat3& hand_axes_ps, HandSide side,
                const ArmTuning& tuning);

// Elbow positions that the bone lengths allow: a circle about the line from shoulder to hand.
// Positions are relative to the shoulder.
struct ElbowCircle {
    Vec3 axis_ts = -Vec3::UnitY();  // unit, towards the hand
    Vec3 middle_ts = Vec3::Zero();
    double radius_m = 0.0;
};
ElbowCircle elbow_circle(double distance_m, const Vec3& axis_ts, double upper_m, double forearm_m);

// Returns the elbow direction closest to `bend_ts` (unit, perpendicular to the axis) for which the
// upper arm is inside the shoulder's cone (ArmTuning::elbow_cone). If the whole circle is outside
// the cone, returns the direction nearest to the cone.
Vec3 reachable_bend(const ElbowCircle& circle, const Vec3& bend_ts, HandSide side,
                    const ArmTuning& tuning);

// Adapts the last frame's elbow direction to the current line from shoulder to hand. If the arm is
// straight, the direction turns with the line, without rotating about it. The more the arm is bent,
// the more its elbow keeps its position (ArmTuning::elbow_inertia).
Vec3 carry_bend(const ArmMemory::Arm& arm, const Vec3& axis_ts, const ArmTuning& tuning);

// How far turn_bend turns: by this share of the angle, but by at most `most_rad`.
struct BendTurn {
    double share = 0.0;
    double most_rad = 0.0;
};
// Turns `bend_ts` about the axis towards `wanted_ts`.
Vec3 turn_bend(const Vec3& axis_ts, const Vec3& bend_ts, const Vec3& wanted_ts,
               const BendTurn& turn);

}  // namespace handhold

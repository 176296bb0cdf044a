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
    const Column<PalmPose>& palm;          // in: hands as they are shown
    Column<ArmMemory>& memory;             // in/out
    Column<ArmEstimate>& estimate;         // out
};

// Stage 12. Chest, shoulders and the side of each elbow of every player, from his head and hands:
// rows 19 to 22 of the talk. In play space throughout, so that a player may hang upside down or
// turn with a ship. Where the head or a hand jumps, the memory starts afresh.
void estimate_arms(const EstimateArmsIo& io, const ArmTuning& tuning);

// The steps of it, each for one player. A level direction is a unit vector without y.

// Where a head looks whose axes these are, level. Beyond 45 degrees of pitch its up (looking up:
// the opposite) joins in.
Vec3 level_look(const Vec3& ahead, const Vec3& up);

// The share of the way that a low-pass filter of `lag_s` goes in dt_s. Implicit: what moves
// steadily lags by lag_s at any frame rate.
inline double follow_share(double dt_s, double lag_s) { return dt_s / (dt_s + lag_s); }

// `look_ps` turned towards `now_ps` by that share of the angle; both level.
Vec3 follow_look(const Vec3& look_ps, const Vec3& now_ps, double share);

// `facing_ps` turned towards `now_ps` by at most `most_rad`; both level.
Vec3 turn_at_most(const Vec3& facing_ps, const Vec3& now_ps, double most_rad);

// How the chest leans: the rotation of play space's up by a share of the head's tilt.
Quat chest_lean(const Vec3& head_up_ps, double share);

// A hand against the eyes.
struct HandReach {
    Vec3 position;  // in arm lengths
    Vec3 back;      // the back of the hand, unit
};
// The largest angle by which something turns, at most half a turn.
struct TurnLimit {
    double sine = 0.0;
    double cosine = 1.0;
};
// Where the chest faces, level, from where the head does and the hands as the leaning chest sees
// them: their sum turns it a little, the line between them is what it is square to, and hands that
// roll turn it along.
Vec3 chest_facing(const Vec3& look_ps, const Quat& lean_ps,
                  const std::array<HandReach, k_hand_count>& hands_ps, const TurnLimit& limit,
                  const ArmTuning& tuning);

// How far the clavicle moves the shoulder towards a hand at `hand` from it, in torso axes and arm
// lengths; metres.
Vec3 clavicle_shift(const Vec3& hand, const ArmTuning& tuning);

// How far a shoulder follows a hand at `hand_m` that the arm does not reach; both from the
// shoulder.
Vec3 shoulder_follow(const Vec3& hand_m, double arm_m, const ArmTuning& tuning);

// To which side the elbow of a hand points, not of unit length; torso axes.
Vec3 elbow_pole(const Vec3& facing_ps, const Mat3& hand_axes_ps, HandSide side,
                const ArmTuning& tuning);

// Where the bones let an elbow be: on a circle about the line to the hand. From the shoulder.
struct ElbowCircle {
    Vec3 axis_ts = -Vec3::UnitY();  // unit: to the hand
    Vec3 middle_ts = Vec3::Zero();
    double radius_m = 0.0;
};
ElbowCircle elbow_circle(double distance_m, const Vec3& axis_ts, double upper_m, double forearm_m);

// The side nearest to `bend_ts` (unit, square to the axis) where a shoulder lets the upper arm
// point: within a cone ahead, outward and down. Where the whole circle lies outside, the side that
// is least so.
Vec3 reachable_bend(const ElbowCircle& circle, const Vec3& bend_ts, HandSide side,
                    const ArmTuning& tuning);

// The last frame's side of the elbow, square to the line to the hand now. It goes along with the
// line without turning about it where the arm is straight; a bent arm's elbow rather stays where it
// was.
Vec3 carry_bend(const ArmMemory::Arm& arm, const Vec3& axis_ts, const ArmTuning& tuning);

// `bend_ts` turned about the axis towards `wanted_ts` by a share of the way, at most by an angle.
struct BendTurn {
    double share = 0.0;
    double most_rad = 0.0;
};
Vec3 turn_bend(const Vec3& axis_ts, const Vec3& bend_ts, const Vec3& wanted_ts,
               const BendTurn& turn);

}  // namespace handhold

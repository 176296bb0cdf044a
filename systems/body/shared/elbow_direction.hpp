#pragma once

#include <array>

#include "components/arm.hpp"
#include "components/body_tuning.hpp"
#include "engine/math/math.hpp"
#include "systems/body/shared/body_view.hpp"

// Estimates shoulder and elbow of each arm by the talk's formulas (rows 20 to 22), and corrects the
// elbow's direction by a network. Torso axes (_ts): -Z where the chest faces, +Y the play space's
// up. Constants: body_constants.hpp, fitted by tools/lab/fit_body.
namespace handhold {

// Displacement of the shoulder by the clavicle's movement, in the player's metres. `hand`: position
// relative to the shoulder at rest, in torso axes and arm lengths.
Vec3 clavicle_shift(const Vec3& hand, const ArmTuning& tuning);

// Displacement of the shoulder towards a hand that the arm does not reach. `hand_m`: position
// relative to the shoulder. `shifted_m`: by how much the clavicle has displaced it already; both
// together are at most ArmTuning::shoulder_follow_m, or what the clavicle alone displaces.
Vec3 shoulder_follow(const Vec3& hand_m, double arm_m, double shifted_m, const ArmTuning& tuning);

// The line from a shoulder to its hand.
struct ArmLine {
    Vec3 shoulder_ts;  // offset from the shoulder at rest
    Vec3 reach_ts;     // vector from the shoulder to the hand
    double distance_m;
    Vec3 axis_ts;  // unit, along reach_ts
};

// Direction in which the elbow of `side` points, torso axes, not normalised.
Vec3 elbow_pole(const BodyView& view, HandSide side);

// What the network adds to elbow_pole. Zero for inputs that do not resemble its data, and for a
// hand near its shoulder (body_constants::k_near_shoulder). `turned`: sine of the angle from the
// chest's facing to the look direction.
Vec3 elbow_correction(const BodyView& view, const std::array<ArmLine, k_hand_count>& lines,
                      double turned, double arm_m, HandSide side);

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

// Limits of turn_bend: it turns by this share of the angle, but by at most `most_rad`.
struct BendTurn {
    double share = 0.0;
    double most_rad = 0.0;
};
// Turns `bend_ts` about the axis towards `wanted_ts`.
Vec3 turn_bend(const Vec3& axis_ts, const Vec3& bend_ts, const Vec3& wanted_ts,
               const BendTurn& turn);

}  // namespace handhold

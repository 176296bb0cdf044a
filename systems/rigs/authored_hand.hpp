#pragma once

#include <optional>

#include "components/authored_grip.hpp"
#include "engine/math/math.hpp"

// Geometry of authored grips: mirroring, distances and the angles they give a finger.
namespace handhold {

// The other hand in the mirror image of a body: across the plane through the body's origin whose
// normal is that axis of the body's frame (0 x, 1 y, 2 z). Its own mirror image.
AuthoredHand mirror_authored_hand(const AuthoredHand& hand, int body_axis);

// How far a hand is from a grip, both in one frame.
struct GripSync {
    double palm_m = 0.0;  // between the centres of the palms
    double turn_rad = 0.0;
};
GripSync grip_sync(const Pose& hand, const Pose& grip_wrist, const Vec3& palm_center_hs);

// Moves `from` towards `to`, position and rotation the same share of their way, a radian counted as
// m_per_rad, by step_m at most. `to` itself, bit for bit, where it is that near.
Pose step_towards(const Pose& from, const Pose& to, double step_m, double m_per_rad);

// The angles a grip gives a finger of the rig, within the finger's limits; none where it gives
// none.
std::optional<FingerAngles> posed_angles(const FingerRig& finger, const AuthoredHand& hand);

}  // namespace handhold

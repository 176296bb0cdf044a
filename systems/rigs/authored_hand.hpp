#pragma once

#include <optional>

#include "components/authored_grip.hpp"
#include "engine/math/math.hpp"

// Geometry of authored grips: mirroring, distances to a hand, and finger angles.
namespace handhold {

// Mirrors a hand across the plane through the body's origin whose normal is that axis of the body's
// frame (0 x, 1 y, 2 z). The result is a hand of the other side; mirroring twice returns `hand`.
AuthoredHand mirror_authored_hand(const AuthoredHand& hand, int body_axis);

// Distance between a hand and a grip in the same frame.
struct GripSync {
    double palm_m = 0.0;  // between the centres of the palms
    double turn_rad = 0.0;
};
GripSync grip_sync(const Pose& hand, const Pose& grip_wrist, const Vec3& palm_center_hs);

// Moves `from` towards `to` by at most step_m, with position and rotation by the same share; a
// radian counts as m_per_rad metres. Returns `to` exactly if it is within step_m.
Pose step_towards(const Pose& from, const Pose& to, double step_m, double m_per_rad);

// Finger angles of a grip, clamped to the finger's limits; nothing if the grip does not pose this
// finger.
std::optional<FingerAngles> posed_angles(const FingerRig& finger, const AuthoredHand& hand);

}  // namespace handhold

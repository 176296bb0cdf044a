#pragma once

#include <optional>

#include "components/authored_grip.hpp"
#include "engine/math/math.hpp"

// Geometry of authored grips: mirroring, distance from a hand, and finger angles.
namespace handhold {

// Mirrors a hand across the plane through the body's origin that is perpendicular to the body's
// axis `body_axis` (0 x, 1 y, 2 z). The result is a hand of the other side. Mirroring twice returns
// `hand`.
AuthoredHand mirror_authored_hand(const AuthoredHand& hand, int body_axis);

// Distance of a hand from a grip. The two wrist poses are in the same frame.
struct GripSync {
    double palm_m = 0.0;  // distance from the centre of the hand's palm to that of the grip's palm
    double turn_rad = 0.0;
};
GripSync grip_sync(const Pose& hand, const Pose& grip_wrist, const Vec3& palm_center_hs);

// Moves `from` towards `to` by at most step_m. Position and rotation move by the same share; a
// radian counts as m_per_rad metres. Returns exactly `to` if it is within step_m.
Pose step_towards(const Pose& from, const Pose& to, double step_m, double m_per_rad);

// Returns the finger angles of a grip while the trigger is released, clamped to the finger's
// limits; none if the grip does not pose this finger.
std::optional<FingerAngles> posed_angles(const FingerRig& finger, const AuthoredHand& hand);

// Angles of a posed finger that follows the trigger: `released` at 0, the grip's pressed angles,
// clamped to the finger's limits, at 1, linear between. A finger that does not follow the trigger
// stays at `released`.
FingerAngles triggered_angles(const FingerRig& finger, const AuthoredHand& hand,
                              const FingerAngles& released, double trigger);

}  // namespace handhold

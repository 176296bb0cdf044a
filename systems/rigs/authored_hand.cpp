#include "systems/rigs/authored_hand.hpp"

#include <algorithm>

namespace handhold {
namespace {

// Mirroring across the plane perpendicular to an axis is the negated half turn about that axis. A
// rotation R is mirrored on both sides, so the signs cancel: it becomes half_turn(body axis) * R *
// half_turn(hand's x axis).
Quat half_turn(int axis) {
    Quat turn(0.0, 0.0, 0.0, 0.0);
    turn.coeffs()[axis] = 1.0;
    return turn;
}

FingerAngles clamped_angles(const FingerRig& finger, const FingerAngles& wanted) {
    FingerAngles angles;
    for (std::size_t i = 0; i < finger.link_count; ++i) {
        angles.curl_rad[i] = std::clamp(wanted.curl_rad[i], finger.lower_rad[i],
                                        std::max(finger.lower_rad[i], finger.upper_rad[i]));
    }
    angles.opposition_rad =
        std::clamp(wanted.opposition_rad, finger.lower_opposition_rad,
                   std::max(finger.lower_opposition_rad, finger.upper_opposition_rad));
    return angles;
}

}  // namespace

AuthoredHand mirror_authored_hand(const AuthoredHand& hand, int body_axis) {
    AuthoredHand mirrored = hand;
    mirrored.wrist_bs.position[body_axis] = -hand.wrist_bs.position[body_axis];
    const Quat turned = half_turn(body_axis) * hand.wrist_bs.rotation * half_turn(0);
    // The quaternion is negated, so that mirroring twice returns the same quaternion.
    mirrored.wrist_bs.rotation = Quat(-turned.w(), -turned.x(), -turned.y(), -turned.z());
    return mirrored;
}

GripSync grip_sync(const Pose& hand, const Pose& grip_wrist, const Vec3& palm_center_hs) {
    const Vec3 apart =
        transform_point(hand, palm_center_hs) - transform_point(grip_wrist, palm_center_hs);
    return {apart.norm(),
            rotation_to_vector(hand.rotation.conjugate() * grip_wrist.rotation).norm()};
}

Pose step_towards(const Pose& from, const Pose& to, double step_m, double m_per_rad) {
    const Vec3 way_m = to.position - from.position;
    const Vec3 turn_rad =
        rotation_to_vector((from.rotation.conjugate() * to.rotation).normalized());
    const double all_m = way_m.norm() + m_per_rad * turn_rad.norm();
    if (all_m <= step_m) {
        return to;
    }
    const double share = step_m / all_m;
    return {from.position + share * way_m,
            (from.rotation * rotation_from_vector(share * turn_rad)).normalized()};
}

std::optional<FingerAngles> posed_angles(const FingerRig& finger, const AuthoredHand& hand) {
    const auto name = static_cast<std::size_t>(finger.name);
    if (!hand.is_posed[name]) {
        return std::nullopt;
    }
    return clamped_angles(finger, hand.fingers[name]);
}

FingerAngles triggered_angles(const FingerRig& finger, const AuthoredHand& hand,
                              const FingerAngles& released, double trigger) {
    const auto name = static_cast<std::size_t>(finger.name);
    if (!hand.follows_trigger[name]) {
        return released;
    }
    const FingerAngles pressed = clamped_angles(finger, hand.pressed[name]);
    FingerAngles angles = released;
    for (std::size_t i = 0; i < finger.link_count; ++i) {
        angles.curl_rad[i] += trigger * (pressed.curl_rad[i] - released.curl_rad[i]);
    }
    angles.opposition_rad += trigger * (pressed.opposition_rad - released.opposition_rad);
    return angles;
}

}  // namespace handhold

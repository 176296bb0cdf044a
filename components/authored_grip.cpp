#include "components/authored_grip.hpp"

#include <algorithm>

namespace handhold {
namespace {

// Mirrors across the planes of two axes are half turns about them, but for a sign that cancels: so
// a rotation R becomes turn(body axis) R turn(hand's x).
Quat half_turn(int axis) {
    Quat turn(0.0, 0.0, 0.0, 0.0);
    turn.coeffs()[axis] = 1.0;
    return turn;
}

}  // namespace

AuthoredHand mirror_authored_hand(const AuthoredHand& hand, int body_axis) {
    AuthoredHand mirrored = hand;
    mirrored.wrist_bs.position[body_axis] = -hand.wrist_bs.position[body_axis];
    const Quat turned = half_turn(body_axis) * hand.wrist_bs.rotation * half_turn(0);
    // Of the two quaternions of one rotation the one that a second mirror leads back from.
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
    FingerAngles angles;
    for (std::size_t i = 0; i < finger.link_count; ++i) {
        angles.curl_rad[i] = std::clamp(hand.fingers[name].curl_rad[i], finger.lower_rad[i],
                                        std::max(finger.lower_rad[i], finger.upper_rad[i]));
    }
    angles.opposition_rad =
        std::clamp(hand.fingers[name].opposition_rad, finger.lower_opposition_rad,
                   std::max(finger.lower_opposition_rad, finger.upper_opposition_rad));
    return angles;
}

double posed_depth_m(const HingeChain& chain,
                     const std::array<double, k_most_disc_links>& angle_rad,
                     std::span<const PlacedMesh> meshes, ChainFitScratch& scratch) {
    const auto capsules = chain_capsules(chain, angle_rad);
    ChainReach reach;
    reach.base = chain.base;
    for (std::size_t i = 0; i < chain.link_count; ++i) {
        reach.radius_m += chain.length_m[i];
        reach.half_width_m = std::max(reach.half_width_m, chain.radius_m[i]);
    }
    reach.radius_m += reach.half_width_m;
    scratch.patch.gather(reach, meshes);
    const auto to_disc = [&chain](const Vec3& point) {
        const Vec3 local = inverse_transform_point(chain.base, point);
        return Vec2(-local.z(), -local.y());
    };
    double depth_m = 0.0;
    for (std::size_t i = 0; i < chain.link_count; ++i) {
        const SunkCapsule sunk = scratch.patch.find_sunk(
            {to_disc(capsules[i].ends[0]), to_disc(capsules[i].ends[1])}, capsules[i].radius_m, i);
        depth_m = std::max(depth_m, sunk.depth_m);
        // What is beyond the place where a surface goes through the middle counts as sunk, too.
        if (sunk.crossed_at) {
            depth_m += (1.0 - *sunk.crossed_at) * chain.length_m[i];
        }
    }
    return depth_m;
}

}  // namespace handhold

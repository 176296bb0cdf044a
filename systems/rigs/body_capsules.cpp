#include "systems/rigs/body_capsules.hpp"

#include "components/body_tuning.hpp"
#include "components/spine.hpp"

namespace handhold {
namespace {

// Radii for an eye height of k_scale_eye_m.
constexpr double k_upper_arm_radius_m = 0.045;
constexpr double k_forearm_radius_m = 0.037;
constexpr double k_hand_radius_m = 0.03;
constexpr double k_capsule_hand_length_m = 0.12;
constexpr double k_spine_radius_m = 0.12;
constexpr double k_thigh_radius_m = 0.07;
constexpr double k_shin_radius_m = 0.05;

PartCapsule capsule_between(const Pose& frame_ws, const Vec3& end_ws, double radius_m) {
    return {frame_ws, inverse_transform_point(frame_ws, end_ws), radius_m};
}

PartCapsule arm_capsule(const ArmPose::Arm& arm, std::size_t bone, double scale) {
    if (bone == 0) {
        return capsule_between(arm.upper_ws, arm.forearm_ws.position, scale * k_upper_arm_radius_m);
    }
    if (bone == 1) {
        return capsule_between(arm.forearm_ws, arm.hand_ws.position, scale * k_forearm_radius_m);
    }
    return {arm.hand_ws, Vec3(0.0, 0.0, -scale * k_capsule_hand_length_m), scale * k_hand_radius_m};
}

PartCapsule spine_capsule(const SpinePose& spine, std::size_t link, double scale) {
    const Vec3& end_ws =
        link + 1 < k_spine_links ? spine.spine_ws[link + 1].position : spine.pelvis_ws.position;
    return capsule_between(spine.spine_ws[link], end_ws, scale * k_spine_radius_m);
}

PartCapsule leg_capsule(const SpinePose::Leg& leg, bool is_shin, double scale) {
    return is_shin ? capsule_between(leg.shin_ws, leg.foot_ws.position, scale * k_shin_radius_m)
                   : capsule_between(leg.thigh_ws, leg.shin_ws.position, scale * k_thigh_radius_m);
}

}  // namespace

PartCapsule part_capsule(const ArmPose& arms, const SpinePose& spine, const BodyMeasures& measures,
                         BodyPart part) {
    constexpr auto k_arms = static_cast<std::size_t>(BodyPart::left_upper_arm);
    constexpr auto k_spine = static_cast<std::size_t>(BodyPart::upper_spine);
    constexpr auto k_legs = static_cast<std::size_t>(BodyPart::left_thigh);
    constexpr std::size_t k_arm_bones = (k_spine - k_arms) / k_hand_count;
    const double scale = measures.eye_height_m / k_scale_eye_m;
    const auto i = static_cast<std::size_t>(part);
    if (i < k_spine) {
        return arm_capsule(arms.arms[i / k_arm_bones], i % k_arm_bones, scale);
    }
    if (i < k_legs) {
        return spine_capsule(spine, i - k_spine, scale);
    }
    return leg_capsule(spine.legs[(i - k_legs) / 2], (i - k_legs) % 2 == 1, scale);
}

}  // namespace handhold

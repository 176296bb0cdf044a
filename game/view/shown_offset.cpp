#include "game/view/shown_offset.hpp"

namespace handhold {
namespace {

// Turns a bone, which lies along -Z, so that it leads to `end_ws`.
void aim_bone(const Vec3& end_ws, Pose& bone_ws) {
    constexpr double k_shortest_m = 1e-6;
    const Vec3 to = end_ws - bone_ws.position;
    if (to.norm() > k_shortest_m) {
        const Vec3 before = bone_ws.rotation * -Vec3::UnitZ();
        bone_ws.rotation = (rotation_between(before, to.normalized()) * bone_ws.rotation);
    }
}

}  // namespace

RenderPose displaced(const RenderPose& pose, const ShownOffset& by) {
    RenderPose out = pose;
    const auto move = [&by](Pose& part) { part.position += by.head; };
    move(out.head_ws);
    out.head_center_ws += by.head;
    move(out.arms.chest_ws);
    move(out.spine.chest_ws);
    move(out.spine.pelvis_ws);
    for (Pose& link : out.spine.spine_ws) {
        move(link);
    }
    for (SpinePose::Leg& leg : out.spine.legs) {
        move(leg.thigh_ws);
        move(leg.shin_ws);
        move(leg.foot_ws);
    }
    for (std::size_t side = 0; side < k_hand_count; ++side) {
        RenderPose::Hand& hand = out.hands[side];
        const Vec3& hand_by = by.hands[side];
        hand.tracked_ws.position += hand_by;
        hand.shown_ws.position += hand_by;
        hand.ray_from_ws += hand_by;
        hand.ray_to_ws += hand_by;
        ArmPose::Arm& arm = out.arms.arms[side];
        move(arm.clavicle_ws);
        move(arm.upper_ws);
        arm.forearm_ws.position += 0.5 * (by.head + hand_by);
        arm.hand_ws.position += hand_by;
        aim_bone(arm.forearm_ws.position, arm.upper_ws);
        aim_bone(arm.hand_ws.position, arm.forearm_ws);
    }
    return out;
}

}  // namespace handhold

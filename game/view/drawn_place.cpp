#include "game/view/drawn_place.hpp"

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

RenderPose drawn_at(const RenderPose& pose, const DrawnPlace& place) {
    RenderPose out = pose;
    const Vec3 by = place.head_ws.position - pose.head_ws.position;
    const auto move = [&by](Pose& part) { part.position += by; };
    out.head_ws = place.head_ws;
    out.head_center_ws =
        transform_point(place.head_ws * inverse(pose.head_ws), pose.head_center_ws);
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
        const Pose moves = place.wrists_ws[side] * inverse(hand.shown_ws);
        const Vec3 hand_by = place.wrists_ws[side].position - hand.shown_ws.position;
        hand.tracked_ws = moves * hand.tracked_ws;
        hand.shown_ws = place.wrists_ws[side];
        hand.ray_from_ws = transform_point(moves, hand.ray_from_ws);
        hand.ray_to_ws = transform_point(moves, hand.ray_to_ws);
        ArmPose::Arm& arm = out.arms.arms[side];
        move(arm.clavicle_ws);
        move(arm.upper_ws);
        arm.forearm_ws.position += 0.5 * (by + hand_by);
        arm.hand_ws = hand.shown_ws;
        aim_bone(arm.forearm_ws.position, arm.upper_ws);
        aim_bone(arm.hand_ws.position, arm.forearm_ws);
    }
    return out;
}

}  // namespace handhold

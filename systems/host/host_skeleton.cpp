#include "systems/host/host_skeleton.hpp"

#include <algorithm>

#include "components/world_edit.hpp"

namespace handhold {

static_assert(HH_HAND_JOINT_COUNT == k_hand_joint_count);

const HandRig& hand_rig_of(const hh_world& host, Entity hand, HandSide side) {
    const HandRigChoice* const choice = host.world.hand_rig.find(hand);
    const std::vector<HandRig>& more = host.caches.more_hand_rigs;
    return choice != nullptr && choice->index < more.size() ? more[choice->index]
                                                            : host.caches.hand_rigs[index_of(side)];
}

std::array<PosedHandJoints, k_hand_count> shown_hand_joints(const hh_world& host, Entity player) {
    const RenderPose& render = host.world.render_pose.at(player);
    const double scale = host.world.player_origin.at(player).scale;
    std::array<PosedHandJoints, k_hand_count> joints;
    for (const HandSide side : {HandSide::left, HandSide::right}) {
        const HandRig& rig = hand_rig_of(host, hand_of(host.world, player, side), side);
        const RenderPose::Hand& shown = render.hands[index_of(side)];
        joints[index_of(side)] = pose_hand_joints(rig, scale, shown.fingers, shown.shown_ws);
    }
    return joints;
}

const std::array<BodyJointInfo, HH_BODY_JOINT_COUNT> k_body_joints = {{
    {"hips", -1},
    {"spine", HH_HIPS},
    {"chest", HH_SPINE},
    {"upperChest", HH_CHEST},
    {"neck", HH_UPPER_CHEST},
    {"head", HH_NECK},
    {"leftShoulder", HH_UPPER_CHEST},
    {"leftUpperArm", HH_LEFT_SHOULDER},
    {"leftLowerArm", HH_LEFT_UPPER_ARM},
    {"leftHand", HH_LEFT_LOWER_ARM},
    {"rightShoulder", HH_UPPER_CHEST},
    {"rightUpperArm", HH_RIGHT_SHOULDER},
    {"rightLowerArm", HH_RIGHT_UPPER_ARM},
    {"rightHand", HH_RIGHT_LOWER_ARM},
    {"leftUpperLeg", HH_HIPS},
    {"leftLowerLeg", HH_LEFT_UPPER_LEG},
    {"leftFoot", HH_LEFT_LOWER_LEG},
    {"rightUpperLeg", HH_HIPS},
    {"rightLowerLeg", HH_RIGHT_UPPER_LEG},
    {"rightFoot", HH_RIGHT_LOWER_LEG},
}};

std::array<Pose, HH_BODY_JOINT_COUNT> pose_body_joints(const RenderPose& render) {
    std::array<Pose, HH_BODY_JOINT_COUNT> out;
    const SpinePose& spine = render.spine;
    out[HH_HIPS] = spine.pelvis_ws;
    out[HH_SPINE] = spine.spine_ws[2];  // links count from the top
    out[HH_CHEST] = spine.spine_ws[1];
    out[HH_UPPER_CHEST] = spine.spine_ws[0];
    out[HH_HEAD] = render.head_ws;
    out[HH_NECK] = {render.arms.chest_ws.position,
                    interpolate(render.arms.chest_ws, render.head_ws, 0.5).rotation};
    constexpr std::size_t k_arm_joints = HH_RIGHT_SHOULDER - HH_LEFT_SHOULDER;
    constexpr std::size_t k_leg_joints = HH_RIGHT_UPPER_LEG - HH_LEFT_UPPER_LEG;
    for (std::size_t side = 0; side < k_hand_count; ++side) {
        const ArmPose::Arm& arm = render.arms.arms[side];
        const SpinePose::Leg& leg = spine.legs[side];
        const std::array arm_ws = {arm.clavicle_ws, arm.upper_ws, arm.forearm_ws, arm.hand_ws};
        const std::array leg_ws = {leg.thigh_ws, leg.shin_ws, leg.foot_ws};
        std::ranges::copy(arm_ws, out.begin() + HH_LEFT_SHOULDER +
                                      static_cast<std::ptrdiff_t>(side * k_arm_joints));
        std::ranges::copy(leg_ws, out.begin() + HH_LEFT_UPPER_LEG +
                                      static_cast<std::ptrdiff_t>(side * k_leg_joints));
    }
    return out;
}

}  // namespace handhold

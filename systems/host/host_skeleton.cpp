#include "systems/host/host_skeleton.hpp"

#include <algorithm>
#include <optional>

#include "systems/rigs/hand_joint_names.hpp"
#include "systems/rigs/hand_kinematics.hpp"

namespace handhold {
namespace {

// Indices of joints in XR_EXT_hand_tracking's order.
constexpr std::size_t k_palm = 0;
constexpr std::size_t k_wrist = 1;
constexpr std::size_t k_thumb_finger = 2;  // metacarpal, proximal, distal, tip
constexpr std::size_t k_first_finger = 6;  // metacarpal, proximal, intermediate, distal, tip
constexpr std::size_t k_joints_of_finger = 5;

std::size_t joint_of(FingerName finger, HandBone bone) {
    const auto number = static_cast<std::size_t>(finger);
    const auto at = static_cast<std::size_t>(bone);
    if (finger == FingerName::thumb) {  // a thumb has no intermediate bone
        return k_thumb_finger + (bone >= HandBone::intermediate ? at - 1 : at);
    }
    return k_first_finger + (number - 1) * k_joints_of_finger + at;
}

// Bone for a link of a finger. The last link is the distal bone. The first link is the proximal
// bone, but in a thumb with three links it is the metacarpal.
HandBone bone_of_link(const FingerRig& finger, std::uint32_t link) {
    if (link + 1 == finger.link_count) {
        return HandBone::distal;
    }
    if (finger.name == FingerName::thumb && finger.link_count == k_max_links) {
        return link == 0 ? HandBone::metacarpal : HandBone::proximal;
    }
    return link == 0 ? HandBone::proximal : HandBone::intermediate;
}

// Position of the rig's joint with this name, in its link's frame or in hand space. None if the rig
// has no such joint.
std::optional<Vec3> named_place(const HandRig& rig, std::int32_t finger, FingerName name,
                                HandBone bone) {
    for (const RigJoint& joint : rig.joints) {
        const auto parsed = parse_hand_joint_name(joint.name);
        if (joint.finger == finger && parsed && parsed->finger == name && parsed->bone == bone) {
            return joint.joint_in_link.position;
        }
    }
    return std::nullopt;
}

void pose_finger(const HandRig& rig, std::size_t index, const FingerAngles& angles,
                 const Pose& wrist_ws, PosedHandJoints& out) {
    const FingerRig& finger = rig.fingers[index];
    const auto frames = finger_link_frames(finger, angles);
    for (std::uint32_t link = 0; link < finger.link_count; ++link) {
        out[joint_of(finger.name, bone_of_link(finger, link))] = {wrist_ws * frames[link],
                                                                  finger.radius_m[link], true};
    }
    const std::uint32_t last = finger.link_count - 1;
    const Vec3 tip = named_place(rig, static_cast<std::int32_t>(index), finger.name, HandBone::tip)
                         .value_or(-finger.length_m[last] * Vec3::UnitZ());
    const Pose tip_hs{transform_point(frames[last], tip), frames[last].rotation};
    out[joint_of(finger.name, HandBone::tip)] = {wrist_ws * tip_hs, finger.radius_m[last], true};
    if (finger.name == FingerName::thumb) {
        return;
    }
    if (const auto place = named_place(rig, RigJoint::k_palm, finger.name, HandBone::metacarpal)) {
        const Pose metacarpal_hs{*place,
                                 look_rotation(finger.base_hs.position - *place, Vec3::UnitY())};
        out[joint_of(finger.name, HandBone::metacarpal)] = {wrist_ws * metacarpal_hs,
                                                            finger.radius_m[0], true};
    }
}

}  // namespace

const HandRig& hand_rig_of(const hh_world& host, Entity hand, HandSide side) {
    const HandRigChoice* const choice = host.world.hand_rig.find(hand);
    const std::vector<HandRig>& more = host.caches.more_hand_rigs;
    return choice != nullptr && choice->index < more.size() ? more[choice->index]
                                                            : host.caches.hand_rigs[index_of(side)];
}

std::int32_t hand_joint_parent(std::size_t joint) {
    if (joint == k_wrist) {
        return -1;
    }
    const bool is_first =
        joint == k_palm || joint == k_thumb_finger ||
        (joint >= k_first_finger && (joint - k_first_finger) % k_joints_of_finger == 0);
    return static_cast<std::int32_t>(is_first ? k_wrist : joint - 1);
}

PosedHandJoints pose_hand_joints(const HandRig& rig, double scale,
                                 const std::array<FingerAngles, k_finger_count>& angles,
                                 const Pose& shown_wrist_ws) {
    // In the hand's metres: the world's over the scale.
    const Pose wrist_ws{shown_wrist_ws.position / scale, shown_wrist_ws.rotation};
    PosedHandJoints out;
    const double palm_radius_m = rig.palm.empty() ? 0.0 : rig.palm.front().radius_m;
    Vec3 palm_hs = rig.palm_center_hs;
    palm_hs.y() = 0.0;  // moves the point from the skin to the height of the bones
    out[k_palm] = {wrist_ws * Pose{palm_hs, Quat::Identity()}, palm_radius_m, true};
    out[k_wrist] = {wrist_ws, palm_radius_m, true};
    for (std::size_t i = 0; i < rig.fingers.size(); ++i) {
        pose_finger(rig, i, angles[i], wrist_ws, out);
    }
    for (std::size_t i = 0; i < out.size(); ++i) {  // parents come first
        if (const std::int32_t parent = hand_joint_parent(i); !out[i].is_valid && parent >= 0) {
            out[i].pose_ws = out[static_cast<std::size_t>(parent)].pose_ws;
        }
    }
    for (PosedHandJoint& joint : out) {
        joint.pose_ws.position *= scale;
        joint.radius_m *= scale;
    }
    return out;
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

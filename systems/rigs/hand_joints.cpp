#include "systems/rigs/hand_joints.hpp"

#include <optional>

#include "systems/rigs/hand_kinematics.hpp"

namespace handhold {
namespace {

// Indices of joints in XR_EXT_hand_tracking's order.
constexpr std::size_t k_palm = 0;
constexpr std::size_t k_wrist = 1;
constexpr std::size_t k_thumb_finger = 2;  // metacarpal, proximal, distal, tip
constexpr std::size_t k_first_finger = 6;  // metacarpal, proximal, intermediate, distal, tip
constexpr std::size_t k_joints_of_finger = 5;

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
        out[hand_joint_index(finger.name, bone_of_link(finger, link))] = {
            wrist_ws * frames[link], finger.radius_m[link], true};
    }
    const std::uint32_t last = finger.link_count - 1;
    const Vec3 tip = named_place(rig, static_cast<std::int32_t>(index), finger.name, HandBone::tip)
                         .value_or(-finger.length_m[last] * Vec3::UnitZ());
    const Pose tip_hs{transform_point(frames[last], tip), frames[last].rotation};
    out[hand_joint_index(finger.name, HandBone::tip)] = {wrist_ws * tip_hs, finger.radius_m[last],
                                                         true};
    if (finger.name == FingerName::thumb) {
        return;
    }
    if (const auto place = named_place(rig, RigJoint::k_palm, finger.name, HandBone::metacarpal)) {
        const Pose metacarpal_hs{*place,
                                 look_rotation(finger.base_hs.position - *place, Vec3::UnitY())};
        out[hand_joint_index(finger.name, HandBone::metacarpal)] = {wrist_ws * metacarpal_hs,
                                                                    finger.radius_m[0], true};
    }
}

}  // namespace

std::size_t hand_joint_index(FingerName finger, HandBone bone) {
    const auto number = static_cast<std::size_t>(finger);
    const auto at = static_cast<std::size_t>(bone);
    if (finger == FingerName::thumb) {  // a thumb has no intermediate bone
        return k_thumb_finger + (bone >= HandBone::intermediate ? at - 1 : at);
    }
    return k_first_finger + (number - 1) * k_joints_of_finger + at;
}

FingerName finger_of_hand_joint(std::size_t joint) {
    return joint < k_first_finger
               ? FingerName::thumb
               : static_cast<FingerName>(1 + (joint - k_first_finger) / k_joints_of_finger);
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

}  // namespace handhold

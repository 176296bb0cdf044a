#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "systems/host/host_world.hpp"

// Joints of hands and bodies with the names that other engines give them.
namespace handhold {

struct PosedHandJoint {
    Pose pose_ws;
    double radius_m = 0.0;
    bool is_valid = false;
};
using PosedHandJoints = std::array<PosedHandJoint, HH_HAND_JOINT_COUNT>;

// The rig with which the hand is shown.
const HandRig& hand_rig_of(const hh_world& host, Entity hand, HandSide side);
// The joints of a hand whose wrist is shown at `wrist_ws`, in the order and with the axes of
// XR_EXT_hand_tracking: -Z from a joint to the next one, +Y to the back of the hand. Joints that
// the rig lacks are not valid and have the pose of their parent. The hand has `scale` times the
// rig's lengths.
PosedHandJoints pose_hand_joints(const HandRig& rig, double scale,
                                 const std::array<FingerAngles, k_finger_count>& angles,
                                 const Pose& wrist_ws);
// Index of the joint's parent; -1 for the wrist.
std::int32_t hand_joint_parent(std::size_t joint);

struct BodyJointInfo {
    const char* name;
    std::int32_t parent;  // index; -1: the root
};
// Indexed by hh_body_joint.
extern const std::array<BodyJointInfo, HH_BODY_JOINT_COUNT> k_body_joints;
// World poses of the shown body's joints, indexed by hh_body_joint.
std::array<Pose, HH_BODY_JOINT_COUNT> pose_body_joints(const RenderPose& render);

}  // namespace handhold

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "components/hand_rig.hpp"
#include "systems/rigs/hand_joint_names.hpp"

// Joints of a posed hand in the order and with the axes of XR_EXT_hand_tracking.
namespace handhold {

inline constexpr std::size_t k_hand_joint_count = 26;

struct PosedHandJoint {
    Pose pose_ws;
    double radius_m = 0.0;
    bool is_valid = false;
};
using PosedHandJoints = std::array<PosedHandJoint, k_hand_joint_count>;

// The joints of a hand whose wrist is shown at `wrist_ws`: -Z from a joint to the next one, +Y to
// the back of the hand. Joints that the rig lacks are not valid and have the pose of their parent.
// The hand has `scale` times the rig's lengths.
PosedHandJoints pose_hand_joints(const HandRig& rig, double scale,
                                 const std::array<FingerAngles, k_finger_count>& angles,
                                 const Pose& wrist_ws);

// Index of a finger's joint in PosedHandJoints. A thumb has no intermediate bone: its distal one is
// meant.
std::size_t hand_joint_index(FingerName finger, HandBone bone);
// The finger of a joint from the thumb's metacarpal on.
FingerName finger_of_hand_joint(std::size_t joint);
// Index of the joint's parent; -1 for the wrist.
std::int32_t hand_joint_parent(std::size_t joint);

}  // namespace handhold

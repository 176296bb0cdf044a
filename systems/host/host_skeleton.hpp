#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "systems/host/host_world.hpp"
#include "systems/rigs/hand_joints.hpp"

// Joints of hands and bodies with the names that other engines give them.
namespace handhold {

// The rig with which the hand is shown.
const HandRig& hand_rig_of(const hh_world& host, Entity hand, HandSide side);
// The joints of both shown hands of a player.
std::array<PosedHandJoints, k_hand_count> shown_hand_joints(const hh_world& host, Entity player);

// Fits a body rig to the skeleton of hh_player_set_body_skeleton, or throws HostError.
BodyRig fit_skeleton(std::span<const hh_skeleton_joint> joints, hh_space space);

struct BodyJointInfo {
    const char* name;
    std::int32_t parent;  // index; -1: the root
};
// Indexed by hh_body_joint.
extern const std::array<BodyJointInfo, HH_BODY_JOINT_COUNT> k_body_joints;
// World poses of the shown body's joints, indexed by hh_body_joint.
std::array<Pose, HH_BODY_JOINT_COUNT> pose_body_joints(const RenderPose& render);

}  // namespace handhold

#pragma once

#include <array>
#include <string>
#include <vector>

#include "components/hand_rig.hpp"
#include "engine/io/gltf_skin_writer.hpp"

namespace handhold {

// The robot's hand over a rig, posed: each part on its joint, each joint below its parent. Numbers
// that a skin lacks (radii, lengths of last links, the palm's capsules) are extras of the joints'
// nodes. Precondition: the rig has joints.
struct RobotHandSkin {
    std::vector<GltfMaterial> materials;
    GltfSkin skin;
};
RobotHandSkin make_robot_hand_skin(const HandRig& rig,
                                   const std::array<FingerAngles, k_finger_count>& fingers,
                                   const Pose& wrist_ms);

// Such a hand in the rest pose as a .glb for animation packages. hand_rig_from_skin reads the same
// rig back. Precondition: the rig has joints.
std::string export_robot_hand(const HandRig& rig);

// `handhold export-hands`: robot_hand_left.glb and robot_hand_right.glb, of the built-in rig.
// Returns the exit status: 0, or 2 after one line on standard error.
int export_hands_command(const std::string& folder);

}  // namespace handhold

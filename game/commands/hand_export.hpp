#pragma once

#include <array>
#include <string>
#include <vector>

#include "components/hand_rig.hpp"
#include "engine/io/gltf_skin_writer.hpp"

namespace handhold {

// The robot's hand over a rig, posed: parts on their joints, joints by their names, each below the
// one that moves it. What a skin does not tell (radii, lengths of last links, the palm's capsules)
// stands in the extras of the joints' nodes. Precondition: the rig has joints.
struct RobotHandSkin {
    std::vector<GltfMaterial> materials;
    GltfSkin skin;
};
RobotHandSkin make_robot_hand_skin(const HandRig& rig,
                                   const std::array<FingerAngles, k_finger_count>& fingers,
                                   const Pose& wrist_ms);

// The robot's hand over a rig as a .glb for animation packages: parts on their joints, posed as at
// rest, joints by their names, each below the one that moves it. What a skin does not tell (radii,
// lengths of last links, the palm's capsules) stands in the extras of the joints' nodes, where
// hand_rig_from_skin looks for it: it gives the same rig again. Precondition: the rig has joints.
std::string export_robot_hand(const HandRig& rig);

// `handhold export-hands`: robot_hand_left.glb and robot_hand_right.glb, of the built-in rig.
// Returns the exit status: 0, or 2 after one line on standard error.
int export_hands_command(const std::string& folder);

}  // namespace handhold

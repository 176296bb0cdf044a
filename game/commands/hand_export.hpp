#pragma once

#include <array>
#include <string>
#include <vector>

#include "components/hand_rig.hpp"
#include "game/commands/exported_objects.hpp"

namespace handhold {

// The robot's hand built for a rig, in a given pose. Each part is bound to its joint, and joints
// form a hierarchy. Values that a skin cannot express (radii, lengths of last links, the palm's
// capsules) are extras of the joints' nodes. Precondition: the rig has joints.
struct RobotHandSkin {
    std::vector<GltfMaterial> materials;
    GltfSkin skin;
};
RobotHandSkin make_robot_hand_skin(const HandRig& rig,
                                   const std::array<FingerAngles, k_finger_count>& fingers,
                                   const Pose& wrist_ms);

// A .glb of the robot's hand in the rest pose, for animation software, with the controller in it if
// one is given. hand_rig_from_skin gives the same rig back. Precondition: the rig has joints.
std::string export_robot_hand(const HandRig& rig, const ControllerModel* controller = nullptr);

// `handhold export-hands`: writes robot_hand_left.glb and robot_hand_right.glb for the built-in
// rig. `controllers`: a name or file for choose_controllers; empty: none. Returns the exit status:
// 0, or 2 after one line on standard error.
int export_hands_command(const std::string& folder, const std::string& controllers);

}  // namespace handhold

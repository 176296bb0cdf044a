#pragma once

#include <optional>
#include <string_view>

#include "components/hand_rig.hpp"

namespace handhold {

enum class HandBone : std::uint8_t { metacarpal, proximal, intermediate, distal, tip };
inline constexpr std::size_t k_hand_bone_count = 5;

struct HandJointName {
    FingerName finger = FingerName::index;
    HandBone bone = HandBone::proximal;
};

// Reads finger and bone from a joint's name, such as "index-finger-phalanx-proximal",
// "XR_HAND_JOINT_LITTLE_TIP_EXT" or "PinkyDistal_L". Ignores case and surrounding text. Returns
// none if the name is not that of a finger's joint.
std::optional<HandJointName> parse_hand_joint_name(std::string_view name);
bool is_wrist_name(std::string_view name);

// The joint's WebXR name, such as "pinky-finger-phalanx-proximal".
std::string hand_joint_text(HandJointName joint);

}  // namespace handhold

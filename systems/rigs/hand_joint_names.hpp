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

// What a joint is by its name, whatever its letters' case and what stands around the words:
// "index-finger-phalanx-proximal", "XR_HAND_JOINT_LITTLE_TIP_EXT" and "PinkyDistal_L" are known.
// Nothing where it is no joint of a finger.
std::optional<HandJointName> parse_hand_joint_name(std::string_view name);
bool is_wrist_name(std::string_view name);

// WebXR's name: "pinky-finger-phalanx-proximal".
std::string hand_joint_text(HandJointName joint);

}  // namespace handhold

#pragma once

#include <array>
#include <cstdint>
#include <span>

// Which control of which controller triggers which action, as data without OpenXR's types.
namespace handhold {

enum class HeadsetAction : std::uint8_t {
    grip_pose,
    aim_pose,
    palm_pose,  // only if the runtime has XR_EXT_palm_pose
    squeeze,
    trigger,
    stick,
    brake,
    calibrate,
    shake,
    count
};
inline constexpr std::size_t k_headset_action_count =
    static_cast<std::size_t>(HeadsetAction::count);

enum class ActionKind : std::uint8_t { pose, number, button, stick, shake };

struct HeadsetActionName {
    HeadsetAction action;
    ActionKind kind;
    const char* name;  // OpenXR allows a to z, digits, -, _ and .
    const char* said;  // name shown in the runtime's settings
};
// Indexed by HeadsetAction.
extern const std::array<HeadsetActionName, k_headset_action_count> k_headset_actions;

// One control of a hand's controller. `path` is appended to /user/hand/left or /user/hand/right.
struct HeadsetBinding {
    HeadsetAction action;
    const char* path;
    enum class Hands : std::uint8_t { both, left, right } hands = Hands::both;
};

struct HeadsetProfile {
    const char* path;  // OpenXR's interaction profile
    std::span<const HeadsetBinding> bindings;
};
// Touch, Index, Vive, Windows Mixed Reality, and the simple controller that every runtime has.
std::span<const HeadsetProfile> headset_profiles();

}  // namespace handhold

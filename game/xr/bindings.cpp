#include "game/xr/bindings.hpp"

namespace handhold {
namespace {

using enum HeadsetAction;
using Hands = HeadsetBinding::Hands;

constexpr const char* k_grip_path = "/input/grip/pose";
constexpr const char* k_aim = "/input/aim/pose";
constexpr const char* k_palm = "/input/palm_ext/pose";
constexpr const char* k_shake = "/output/haptic";

constexpr std::array<HeadsetBinding, 11> k_touch = {{
    {grip_pose, k_grip_path},
    {aim_pose, k_aim},
    {palm_pose, k_palm},
    {squeeze, "/input/squeeze/value"},
    {trigger, "/input/trigger/value"},
    {stick, "/input/thumbstick"},
    {brake, "/input/x/click", Hands::left},
    {brake, "/input/a/click", Hands::right},
    {calibrate, "/input/y/click", Hands::left},
    {calibrate, "/input/b/click", Hands::right},
    {shake, k_shake},
}};
constexpr std::array<HeadsetBinding, 9> k_index = {{
    {grip_pose, k_grip_path},
    {aim_pose, k_aim},
    {palm_pose, k_palm},
    {squeeze, "/input/squeeze/value"},
    {trigger, "/input/trigger/value"},
    {stick, "/input/thumbstick"},
    {brake, "/input/a/click"},
    {calibrate, "/input/b/click"},
    {shake, k_shake},
}};
constexpr std::array<HeadsetBinding, 9> k_vive = {{
    {grip_pose, k_grip_path},
    {aim_pose, k_aim},
    {palm_pose, k_palm},
    {squeeze, "/input/squeeze/click"},
    {trigger, "/input/trigger/value"},
    {stick, "/input/trackpad"},
    {brake, "/input/trackpad/click"},
    {calibrate, "/input/menu/click"},
    {shake, k_shake},
}};
constexpr std::array<HeadsetBinding, 9> k_mixed_reality = {{
    {grip_pose, k_grip_path},
    {aim_pose, k_aim},
    {palm_pose, k_palm},
    {squeeze, "/input/squeeze/click"},
    {trigger, "/input/trigger/value"},
    {stick, "/input/thumbstick"},
    {brake, "/input/trackpad/click"},
    {calibrate, "/input/menu/click"},
    {shake, k_shake},
}};
constexpr std::array<HeadsetBinding, 6> k_simple = {{
    {grip_pose, k_grip_path},
    {aim_pose, k_aim},
    {palm_pose, k_palm},
    {squeeze, "/input/select/click"},
    {calibrate, "/input/menu/click"},
    {shake, k_shake},
}};
constexpr std::array<HeadsetProfile, 5> k_profiles = {{
    {"/interaction_profiles/oculus/touch_controller", k_touch},
    {"/interaction_profiles/valve/index_controller", k_index},
    {"/interaction_profiles/htc/vive_controller", k_vive},
    {"/interaction_profiles/microsoft/motion_controller", k_mixed_reality},
    {"/interaction_profiles/khr/simple_controller", k_simple},
}};

}  // namespace

const std::array<HeadsetActionName, k_headset_action_count> k_headset_actions = {{
    {grip_pose, ActionKind::pose, "grip_pose", "Hand"},
    {aim_pose, ActionKind::pose, "aim_pose", "Pointing"},
    {palm_pose, ActionKind::pose, "palm_pose", "Palm"},
    {squeeze, ActionKind::number, "squeeze", "Close the hand"},
    {trigger, ActionKind::number, "trigger", "Close the hand with the finger"},
    {stick, ActionKind::stick, "stick", "Turn (right), jets (left)"},
    {brake, ActionKind::button, "brake", "Brake"},
    {calibrate, ActionKind::button, "calibrate", "Measure me (both hands, in a T-pose)"},
    {shake, ActionKind::shake, "shake", "Touch and grip"},
}};

std::span<const HeadsetProfile> headset_profiles() { return k_profiles; }

}  // namespace handhold

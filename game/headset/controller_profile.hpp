#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "components/tracking.hpp"
#include "components/tuning.hpp"
#include "components/world.hpp"
#include "engine/io/result.hpp"
#include "engine/math/math.hpp"
#include "game/headset/controller_motion.hpp"

// How controllers sit in hands, as data: docs/reference/controllers.md. Talk row 9.
//
// The grip pose is what is tracked: OpenXR's and WebXR's, -Z along the handle from the little
// finger to the thumb, +X square to the palm: into a right one, out of a left one.
namespace handhold {

// One side's. Suffix _ms: in the frame of the controller's model.
struct ControllerFit {
    Pose grip_ms;
    Pose aim_ms;        // from where and along whose -Z it points
    Pose hand_in_grip;  // the controller-to-hand joint: the wrist (OpenXR's axes) in the grip pose
};
Pose controller_in_hand(const ControllerFit& fit);  // the model's frame, in hand space

// A handle that lies across the palm, on it.
struct HandleGrip {
    double radius_m = 0.017;
    double slant_rad = 0.55;  // of the handle's thumb end towards the fingers; 0: square to them
    double along_m = 0.018;   // of the grip pose along the handle, towards the thumb, from where
                              // the middle of the palm is
};
// The grip pose in hand space. The left hand's mirrors the right one's.
Pose handle_in_hand(HandSide side, const HandleGrip& handle, const HandTuning& tuning);

// What a profile says, before its models are read.
struct ControllerSide {
    std::filesystem::path model;  // glTF, beside the profile
    ControllerFit fit;
    std::vector<ControlledNode> controls;  // what moves on it
};
struct ControllerProfile {
    std::string name;
    std::array<ControllerSide, k_hand_count> sides;  // by HandSide
};

// One of ours, or the profile.json of a WebXR input profile, whose models stand in the grip pose;
// a hand is around their handle as HandleGrip says, and they aim along the grip. Refused with file,
// JSON pointer and what was expected.
Result<ControllerProfile> parse_controller_profile(std::string_view text,
                                                   const std::filesystem::path& file);

// The joint of a hand of the world: its own, else Tuning's.
Pose controller_joint(const World& world, Entity hand, HandSide side, const HandTuning& tuning);
// Gives all hands of the world these joints. Between frames.
void set_controller_joints(const std::array<Pose, k_hand_count>& hand_in_grip, World& world);

}  // namespace handhold

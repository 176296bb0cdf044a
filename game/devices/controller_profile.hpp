#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "components/tracking.hpp"
#include "components/tuning.hpp"
#include "components/world.hpp"
#include "engine/core/result.hpp"
#include "engine/math/math.hpp"
#include "game/devices/controller_motion.hpp"

// Controller profiles: how a hand holds its controller. Format: docs/reference/controllers.md. Talk
// row 9.
//
// The tracked pose is the grip pose of OpenXR and WebXR: -Z along the handle from the little finger
// to the thumb, +X perpendicular to the palm: into the right palm, out of the left one.
namespace handhold {

// One side. Suffix _ms: in the frame of the controller's model.
struct ControllerFit {
    Pose grip_ms;
    Pose aim_ms;        // origin and -Z of the pointing ray
    Pose hand_in_grip;  // the controller-to-hand joint: the wrist (OpenXR's axes) in the grip pose
};
// Pose of the model's frame in hand space.
Pose controller_in_hand(const ControllerFit& fit);

// A handle that lies across the palm.
struct HandleGrip {
    double radius_m = 0.017;
    double slant_rad = 0.55;  // tilt of the thumb end towards the fingers; 0: perpendicular
    double along_m = 0.018;   // grip pose from the palm's centre along the handle, to the thumb
};
// Grip pose in hand space. The left hand's is the mirror image of the right hand's.
Pose handle_in_hand(HandSide side, const HandleGrip& handle, const HandTuning& tuning);

// The contents of a profile, before its models are read.
struct ControllerSide {
    std::filesystem::path model;  // glTF file
    ControllerFit fit;
    std::vector<ControlledNode> controls;  // moving parts
};
struct ControllerProfile {
    std::string name;
    std::array<ControllerSide, k_hand_count> sides;  // indexed by HandSide
};

// Reads a profile of our own format, or the profile.json of a WebXR input profile. WebXR models are
// given in the grip pose; HandleGrip places the hand on their handle, and they aim along the grip.
// An error names the file, the JSON pointer and what was expected.
Result<ControllerProfile> parse_controller_profile(std::string_view text,
                                                   const std::filesystem::path& file);

// The controller-to-hand joint of a hand: its own, else Tuning's.
Pose controller_joint(const World& world, Entity hand, HandSide side, const HandTuning& tuning);
// Gives all hands of the world these joints. Call between frames.
void set_controller_joints(const std::array<Pose, k_hand_count>& hand_in_grip, World& world);

}  // namespace handhold

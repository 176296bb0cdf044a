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

// Controller profiles: how a hand holds its controller. Format: docs/reference/controllers.md. Talk
// row 9.
//
// The runtime tracks the grip pose of OpenXR and WebXR: -Z along the handle from the little finger
// to the thumb, +X perpendicular to the palm, into a right palm and out of a left one.
namespace handhold {

// How one hand holds its controller. _ms: in the frame of the controller's model.
struct ControllerFit {
    Pose grip_ms;
    Pose aim_ms;        // the controller points along its -Z
    Pose hand_in_grip;  // controller-to-hand joint: the wrist (OpenXR's axes) in the grip frame
};
// Pose of the model's frame in hand space.
Pose controller_in_hand(const ControllerFit& fit);

// A cylindrical handle that lies across the palm and touches it.
struct HandleGrip {
    double radius_m = 0.017;
    // Tilt of the handle's thumb end towards the fingers; 0: perpendicular to the fingers.
    double slant_rad = 0.55;
    // Offset of the grip pose from the middle of the palm, along the handle towards the thumb.
    double along_m = 0.018;
};
// Grip pose in hand space. The left hand's is the mirror image of the right hand's.
Pose handle_in_hand(HandSide side, const HandleGrip& handle, const HandTuning& tuning);

// One hand's part of a profile, before the model is loaded.
struct ControllerSide {
    std::filesystem::path model;  // glTF file
    ControllerFit fit;
    std::vector<ControlledNode> controls;  // moving parts
};
struct ControllerProfile {
    std::string name;
    std::array<ControllerSide, k_hand_count> sides;  // by HandSide
};

// Reads a profile in Handhold's format, or the profile.json of a WebXR input profile. For WebXR,
// the model's frame and the aim pose are the grip pose, and the hand holds the handle like a
// default HandleGrip. Errors state the file, the JSON pointer and what was expected.
Result<ControllerProfile> parse_controller_profile(std::string_view text,
                                                   const std::filesystem::path& file);

// A hand's controller-to-hand joint: its ControllerToHand, else the default from `tuning`.
Pose controller_joint(const World& world, Entity hand, HandSide side, const HandTuning& tuning);
// Sets the controller-to-hand joints of all hands of the world, by HandSide. Call between frames.
void set_controller_joints(const std::array<Pose, k_hand_count>& hand_in_grip, World& world);

}  // namespace handhold

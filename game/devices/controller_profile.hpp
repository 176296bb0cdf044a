#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <handhold/handhold.hpp>
#include <handhold/math.hpp>

#include "game/devices/controller_motion.hpp"
#include "game/files/file_tools.hpp"

// Controller profiles: how a hand holds its controller. Format: docs/reference/controllers.md. Talk
// row 9.
//
// The tracked pose is the grip pose of OpenXR and WebXR: -Z along the handle from the little finger
// to the thumb, +X perpendicular to the palm: into the right palm, out of the left one.
namespace handhold {

// One side. Suffix _ms: in the frame of the controller's model.
struct ControllerFit {
    hh::Pose grip_ms = hh::k_origin;
    hh::Pose aim_ms = hh::k_origin;  // origin and -Z of the pointing ray
    // Controller-to-hand pose: the wrist (OpenXR's axes) in the grip pose.
    hh::Pose hand_in_grip = hh::k_origin;
};
// Pose of the model's frame in hand space.
hh::Pose controller_in_hand(const ControllerFit& fit);

// A handle that lies across the palm.
struct HandleGrip {
    double radius_m = 0.017;
    double slant_rad = 0.55;  // tilt of the thumb end towards the fingers; 0: perpendicular
    double along_m = 0.018;   // grip pose from the palm's centre along the handle, to the thumb
};
// Grip pose in hand space. The left hand's is the mirror image of the right hand's, whose palm's
// centre is given.
hh::Pose handle_in_hand(hh::Side side, const HandleGrip& handle, hh::Vec3 palm_center_m);

// The contents of a profile, before its models are read.
struct ControllerSide {
    std::filesystem::path model;  // glTF file
    ControllerFit fit;
    std::vector<ControlledNode> controls;  // moving parts
};
struct ControllerProfile {
    std::string name;
    std::array<ControllerSide, 2> sides;  // indexed by hh::Side
};

// Reads a profile of our own format, or the profile.json of a WebXR input profile. WebXR models are
// given in the grip pose; HandleGrip places the hand on their handle, and they aim along the grip.
// An error names the file, the JSON pointer and what was expected.
Result<ControllerProfile> parse_controller_profile(std::string_view text,
                                                   const std::filesystem::path& file);

// Sets the controller-to-hand poses of all hands in the world, by hh::Side. Call between frames.
void set_controller_joints(const std::array<hh::Pose, 2>& hand_in_grip, hh::World& world);

}  // namespace handhold

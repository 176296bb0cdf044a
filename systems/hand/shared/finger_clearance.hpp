#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "components/hand.hpp"
#include "components/hand_surroundings.hpp"
#include "engine/geometry/chain_patch.hpp"

// Tests whether the fingers of a placed palm have clearance. search_grip uses it to evaluate
// candidates, in addition to the palm's own penetration.
//
// A sample pose is one of 8 fixed curls of a finger (for a thumb, at one of 3 oppositions),
// numbered from 1; 0 means none. Testing sample poses bounds a finger's smallest possible
// penetration without fitting the finger.
namespace handhold {

// One sample pose per finger, by index into HandRig::fingers; 0: none.
using FingerSamplePoses = std::array<std::uint8_t, k_finger_count>;

// A finger has clearance if its best sample pose penetrates no deeper than this. Lifting the palm
// resolves such small penetrations.
inline constexpr double k_finger_penetration_tolerance_m = 1.5e-3;

struct FingerClearance {
    // Largest penetration of all digits at their best sample poses; at least 0.
    double penetration_m = 0.0;
    // Per finger: its least penetrating sample pose; 0: the finger has clearance.
    FingerSamplePoses finger_samples = {};
};

// Tests each digit's sample poses, with the wrist at `wrist_bs` (in the frame of
// HandSurroundings::meshes). The penetrations are upper bounds: sweep_fingers can find better
// angles between the sample poses. `patch` is scratch.
FingerClearance find_finger_clearance(const HandSurroundings& hand, const Pose& wrist_bs,
                                      ChainPatch& patch);

// Returns the largest penetration of the fingers in their given sample poses. Fingers with sample
// pose 0 are ignored.
double sample_pose_depth_m(const HandSurroundings& hand, const FingerSamplePoses& finger_samples,
                           const Pose& wrist_bs, ChainPatch& patch);

// Returns the angles of a sample pose; none for 0 and for numbers that are not a sample pose of
// this finger.
std::optional<FingerAngles> sample_pose_angles(const FingerRig& finger, std::uint8_t sample);

}  // namespace handhold

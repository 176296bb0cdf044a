#pragma once

#include <cstdint>
#include <optional>

#include "components/hand.hpp"
#include "components/hand_surroundings.hpp"
#include "engine/geometry/chain_patch.hpp"

// Whether the fingers of a placed palm have clearance. search_grip evaluates candidates by it, in
// addition to the palm's own penetration.
//
// A sample pose is one of 8 fixed curls of a finger (for a thumb, at one of 3 oppositions),
// numbered from 1; 0 means none. It lets a finger's best penetration be bounded without fitting the
// finger.
namespace handhold {

// A finger has clearance if its best sample pose penetrates no deeper than this. Lifting the palm
// resolves the rest.
inline constexpr double k_finger_penetration_tolerance_m = 1.5e-3;

struct FingerClearance {
    double penetration_m = 0.0;  // largest penetration over all digits; at least 0
    // Per finger without clearance, its least penetrating sample pose; 0: has clearance.
    FingerSamplePoses finger_samples = {};
};

// Penetration of each digit at its best sample pose, with the wrist at `wrist_bs` (frame of
// HandSurroundings::meshes). An upper bound to choose surfaces by, not a fit: sweep_fingers can
// find better angles in between. `patch` is scratch.
FingerClearance find_finger_clearance(const HandSurroundings& hand, const Pose& wrist_bs,
                                      ChainPatch& patch);

// Largest penetration of the fingers that have a sample pose, at that pose; 0 if none has one.
double sample_pose_depth_m(const HandSurroundings& hand, const FingerSamplePoses& finger_samples,
                           const Pose& wrist_bs, ChainPatch& patch);

// Angles of a sample pose; none for 0 and for numbers that are no sample pose of this finger.
std::optional<FingerAngles> sample_pose_angles(const FingerRig& finger, std::uint8_t sample);

}  // namespace handhold

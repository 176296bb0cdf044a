#pragma once

#include <cstdint>
#include <optional>

#include "components/hand.hpp"
#include "components/hand_surroundings.hpp"
#include "engine/geometry/chain_patch.hpp"

// Whether a palm leaves its fingers room: what search_grip judges surfaces by, beside the palm's.
namespace handhold {

// Fingers sunk no deeper than this when they bend as is best have room: lifts do the rest.
inline constexpr double k_finger_penetration_tolerance_m = 1.5e-3;

struct FingerClearance {
    double penetration_m = 0.0;  // of the deepest finger or thumb, at least 0
    FingerSamplePoses finger_samples =
        {};  // of those without room, the ones they are sunk least by
};

// How deep fingers and thumb are sunk with the wrist there (in the frame of
// HandSurroundings::meshes), each as a few bends suit it best. A bound for choosing, not a fit:
// sweep_fingers finds bends between these. `patch` is only worked in.
FingerClearance find_finger_clearance(const HandSurroundings& hand, const Pose& wrist_bs,
                                      ChainPatch& patch);

// How deep the deepest of those fingers is that have a bend, bent so; 0 where none has one.
double sample_pose_depth_m(const HandSurroundings& hand, const FingerSamplePoses& finger_samples,
                           const Pose& wrist_bs, ChainPatch& patch);

// None for 0, and for what is no bend of the finger.
std::optional<FingerAngles> sample_pose_angles(const FingerRig& finger, std::uint8_t sample);

}  // namespace handhold

#pragma once

#include "components/hand.hpp"
#include "components/hand_rig.hpp"
#include "components/hand_surroundings.hpp"
#include "components/tuning.hpp"
#include "engine/geometry/chain_fit.hpp"

// Converts fingers and thumbs to chains of hinged capsules, for several hand stages.
namespace handhold {

// Returns the digit's chain in the frame in which `wrist` is given.
HingeChain finger_chain(const FingerRig& finger, double opposition_rad, const Pose& wrist);

ChainFitSettings chain_settings(const FingerTuning& tuning);
// Smallest radius of the digit's links, in metres. If a digit penetrates less than this, no surface
// crosses the axes of its links: the axes are still outside, on the side from which the digit
// closed.
double clear_depth_m(const FingerRig& finger);

// The wrist at PalmOffset::held_*, in the body's frame.
Pose held_wrist_bs(const HandSurroundings& hand, const PalmOffset& offset);

// Returns the seeds of a finger's surface searches on the hand's first mesh: the point under the
// palm, and the point nearest to the middle of the half-closed finger, which may be on another part
// of the mesh. `chain` is in the body's frame. Precondition: the hand has a mesh.
ChainSeed chain_seed(const HandSurroundings& hand, const GripSurface& surface,
                     const HingeChain& chain);

inline constexpr double k_travel_arm_m = 0.1;

// Returns the approximate travel of a hand between two wrist poses: |translation| + k_travel_arm_m
// * |rotation|.
double hand_travel_m(const Pose& from, const Pose& to);

// True if a surface stops the chain. False for a rest pose, even if it penetrates.
bool touches(const ChainFit& fit);

}  // namespace handhold

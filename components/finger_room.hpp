#pragma once

#include "components/hand_surroundings.hpp"
#include "engine/geometry/chain_patch.hpp"

// Whether a palm leaves its fingers room: what search_grip judges surfaces by, beside the palm's.
namespace handhold {

// Fingers sunk no deeper than this when they bend as is best have room: lifts do the rest.
inline constexpr double k_fingers_have_room_m = 1.5e-3;

// How deep the deepest finger or thumb is sunk with the wrist there (in the frame of
// HandSurroundings::meshes), each as a few bends suit it best; at least 0, metres. A bound for
// choosing, not a fit: sweep_fingers finds bends between these. `patch` is only worked in.
double fingers_sunk_m(const HandSurroundings& hand, const Pose& wrist_bs, ChainPatch& patch);

}  // namespace handhold

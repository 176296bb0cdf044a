#pragma once

#include "components/hand_surroundings.hpp"
#include "systems/hand/shared/hand_spheres.hpp"

namespace handhold {

inline constexpr double k_deepest_m = 0.3;
inline constexpr int k_most_faces = 4;  // three faces that meet in a corner, and one more

// Returns the wrist of `pose`, moved so that the player sees the hand: the ends of its capsules'
// axes leave the surfaces that they are behind, the deepest first, at most k_most_faces times. A
// point is behind a mesh if the line from HandSurroundings::eye_bs crosses it an odd number of
// times, so windings do not matter, and walls need neither be closed nor have a thickness. Hands
// that are deeper than k_deepest_m, and all hands if the eye is unknown, stay.
Pose wrist_outside_bs(const HandSurroundings& hand, const HandPose& pose);

// True if the palm's centre is behind a mesh and within k_deepest_m of its surface.
bool is_palm_behind(const HandSurroundings& hand, const Pose& wrist_bs);

}  // namespace handhold

#pragma once

#include "components/hand_surroundings.hpp"
#include "systems/hand/shared/hand_spheres.hpp"

namespace handhold {

// True if a mesh near a point hides it from the eye: the last k_sight_m of the line from the eye to
// the point cross the mesh an odd number of times. Windings do not matter, and walls need neither
// be closed nor have a thickness. Crossings farther away do not count. All in the frame
// of HandSurroundings::wrist_bs.
inline constexpr double k_sight_m = 0.3;
bool is_behind(const PlacedMesh& placed, const Vec3& eye_bs, const Vec3& point_bs);

// True if no end of the capsules' axes is behind a mesh, or if the eye is unknown.
bool is_outside(const HandSurroundings& hand, const HandPose& pose);

// Returns the wrist of `pose`, moved until is_outside: the deepest end first, to its nearest
// surface point. Thin boards may be left at their far side. The wrist stays where it is if the palm
// is more than k_sight_m from all surfaces, or the way out is longer than that.
Pose wrist_outside_bs(const HandSurroundings& hand, const HandPose& pose);

// Returns the smallest translation that brings a sphere at an end of the capsules' axes
// into contact with the gripped body's mesh, HandSurroundings::meshes.front(), in the frame
// of HandSurroundings::wrist_bs. Zero if one touches it, or if none is within `reach_m` >= 0
// of it. A capsule may touch the mesh between its ends: it is then moved deeper.
// Precondition: the hand has meshes.
Vec3 displacement_to_touch(const HandSurroundings& hand, const HandPose& pose, double reach_m);

}  // namespace handhold

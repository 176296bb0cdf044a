#pragma once

#include <array>
#include <span>

#include "components/hand_rig.hpp"
#include "engine/math/math.hpp"

// Forward and inverse kinematics of a rig's fingers, and mirroring.
namespace handhold {

// Frames of a finger's links in hand space. The origin is the link's hinge; -Z points along the
// link.
std::array<Pose, k_max_links> finger_link_frames(const FingerRig& finger,
                                                 const FingerAngles& angles);
// Positions of the hinges and then of the tip, in hand space. Link i's capsule lies between points
// i and i + 1.
std::array<Vec3, k_max_links + 1> finger_points(const FingerRig& finger,
                                                const FingerAngles& angles);

// Inverse of finger_link_frames, for the rotations. If the finger cannot reach the rotations, picks
// the closest opposition or spread, and then, link by link, the closest hinge angle. Does not apply
// the finger's limits.
FingerAngles angles_of_links(const FingerRig& finger, std::span<const Quat> rotations_hs);

// Angles with all hinges at the same share of their range: 0 fully open, 1 fully curled. Opposition
// is 0.
FingerAngles coupled_angles(const FingerRig& finger, double share);
// Angles of the rest pose. Opposition is 0.
FingerAngles relaxed_angles(const FingerRig& finger);

// Mirrors a hand across the plane x = 0. Equal joint angles of both hands give mirrored poses.
HandRig mirror_hand_rig(const HandRig& rig);
Pose mirror_hand_pose(const Pose& pose_hs);

const char* finger_text(FingerName name);  // "thumb", "index", "middle", "ring", "little"

}  // namespace handhold

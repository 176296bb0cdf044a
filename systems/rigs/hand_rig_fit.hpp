#pragma once

#include "components/hand_rig.hpp"
#include "engine/core/result.hpp"
#include "engine/io/gltf_skin.hpp"

// Fits hand rigs to skinned meshes whose joints have WebXR or OpenXR hand-tracking names
// ("index-finger-phalanx-distal", "XR_HAND_JOINT_LITTLE_TIP_EXT"). Required are a wrist and 2 to 5
// fingers, each with 2 or 3 bones and a tip. Metacarpals are optional, and the hierarchy is
// arbitrary.
namespace handhold {

// A file may give sizes itself, in metres, in the extras of joint nodes; they replace measured
// ones. These are the keys. On a link's joint: radius and length of the link's capsule. On the
// wrist, in hand space: the palm's capsules (seven numbers each: a, b and radius) and the palm's
// centre.
inline constexpr const char* k_link_radius_key = "link_radius_m";
inline constexpr const char* k_link_length_key = "link_length_m";
inline constexpr const char* k_palm_capsules_key = "palm_capsules_m";
inline constexpr const char* k_palm_center_key = "palm_center_m";

struct HandRigFit {
    HandRig rig;
    // Joint angles that reproduce the file's pose, by index into HandRig::fingers.
    std::array<FingerAngles, k_finger_count> bind;
    Pose hand_ms;  // pose of hand space in the file's frame
};

inline constexpr double k_min_bone_m = 0.004;
inline constexpr double k_min_hand_m = 0.05;  // least distance from the wrist to the farthest tip
inline constexpr double k_max_hand_m = 1.0;

// Fits a hand rig to a skinned mesh.
// - Uses the joints' positions, but not their axes, since exporters choose these differently. A
//   mirrored right hand is a left hand.
// - Hand space has its origin at the wrist. It is rotated so that the knuckles lie like those of
//   the built-in hand.
// - A finger's hinge axis is a compromise: perpendicular to the finger's bones, and close to the
//   axis across the finger (thumbs: to the built-in thumb's axis). RigJoint stores the joints'
//   offsets from the finger's disc.
// - A link's radius is the median distance of the skin from the bone. The last link ends one radius
//   before the end of the skin. The palm's capsules are flush with the palm's skin.
// - Limits and rest angles are those of the built-in hand; a limit gives way to the file's pose.
//
// Errors (the message names the joints): missing or duplicate joints; fewer than two fingers; bones
// shorter than k_min_bone_m; a hand of the other side, recognised by fingers bent towards the back
// of the hand (a flat hand is accepted as `side`); a hand shorter than k_min_hand_m or longer than
// k_max_hand_m; invalid sizes in the file.
Result<HandRigFit> fit_hand_rig(const SkinnedMesh& skin, HandSide side);
// fit_hand_rig without the bind angles.
Result<HandRig> hand_rig_from_skin(const SkinnedMesh& skin, HandSide side);

}  // namespace handhold

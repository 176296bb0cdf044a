#pragma once

#include "components/hand_rig.hpp"
#include "engine/io/gltf_skin.hpp"
#include "engine/io/result.hpp"

// Fits hand rigs to skinned meshes whose joints have WebXR or OpenXR hand-tracking names
// ("index-finger-phalanx-distal", "XR_HAND_JOINT_LITTLE_TIP_EXT"): a wrist and 2 to 5 fingers of 2
// or 3 bones each with a tip. Metacarpals are optional; any hierarchy.
namespace handhold {

// Keys of numbers in the extras of joints' nodes that replace measured sizes, metres. On a link's
// first joint: its capsule's radius and length. On the wrist: the palm's capsules (a, b, radius:
// seven numbers each, hand space) and the palm's centre.
inline constexpr const char* k_link_radius_key = "link_radius_m";
inline constexpr const char* k_link_length_key = "link_length_m";
inline constexpr const char* k_palm_capsules_key = "palm_capsules_m";
inline constexpr const char* k_palm_center_key = "palm_center_m";

struct HandRigFit {
    HandRig rig;
    // Angles that reproduce the file's joint poses, by index in HandRig::fingers.
    std::array<FingerAngles, k_finger_count> bind;
    Pose hand_ms;  // hand space in the file's frame
};

// All of the rig follows from the joints' positions; their own axes are ignored, since exporters
// choose them differently. A mirrored right hand is a left hand. Hand space is placed at the wrist
// such that the knuckles lie as the built-in hand's do. A finger's hinge axis is perpendicular to
// its bones (rest bend) and close to the level axis across the finger, or the built-in thumb's
// axis; RigJoint keeps the joints' offsets from the finger's plane. Radii are medians of the skin's
// distance from the bones; the last link ends one radius before the skin. The palm's capsules are
// flush with its skin. The file's own numbers replace measured ones. Limits and rest angles are the
// built-in hand's.
//
// Refused, with the names: missing or duplicate joints; fewer than two fingers; bones shorter than
// 4 mm; a hand of the other side (fingers and thumb bent to the back of the hand; a flat hand is
// taken as `side`); a size outside 0.05 to 1 m; invalid numbers in the file.
Result<HandRigFit> fit_hand_rig(const SkinnedMesh& skin, HandSide side);
Result<HandRig> hand_rig_from_skin(const SkinnedMesh& skin, HandSide side);

}  // namespace handhold

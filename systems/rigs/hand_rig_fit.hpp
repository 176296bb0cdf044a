#pragma once

#include "components/hand_rig.hpp"
#include "engine/io/gltf_skin.hpp"
#include "engine/io/result.hpp"

// Hand rigs out of skinned meshes whose joints have the names of WebXR or OpenXR hand tracking
// ("index-finger-phalanx-distal", "XR_HAND_JOINT_LITTLE_TIP_EXT"): a wrist, 2 to 5 fingers of 2 or
// 3 bones each with its tip, metacarpals or not, any hierarchy.
namespace handhold {

// Numbers in the extras of joints' nodes that say what a skin only shows: of a link's first joint
// its capsule's radius and length, of the wrist the palm's capsules (a, b, radius: seven each, hand
// space) and the palm's centre. Metres.
inline constexpr const char* k_link_radius_key = "link_radius_m";
inline constexpr const char* k_link_length_key = "link_length_m";
inline constexpr const char* k_palm_capsules_key = "palm_capsules_m";
inline constexpr const char* k_palm_center_key = "palm_center_m";

struct HandRigFit {
    HandRig rig;
    // The angles at which every joint of the rig stands as in the file.
    std::array<FingerAngles, k_finger_count> bind;  // by place in HandRig::fingers
    Pose hand_ms;                                   // hand space in the file's frame
};

// Hand space is the wrist joint's frame where its axes are OpenXR's (-Z to the fingers, +Y the back
// of the hand); where they are more than 35 degrees off, axes are taken from the knuckles instead.
// A finger's plane is the one nearest to its bones and across its joints' x axes; what the joints
// are off it stays in RigJoint. Radii are medians of the skin's distance from the bones, the last
// link ends a radius before the skin does; the palm's capsules are flush with its skin; numbers of
// the file's own go before. Limits and relaxed angles are the built-in hand's.
//
// Refused, with the names: missing joints, joints twice, fewer than two fingers, bones without a
// length, a hand of the other side, a hand that is not of a hand's size (0.05 to 1 m), numbers of
// the file's own that no hand has.
Result<HandRigFit> fit_hand_rig(const SkinnedMesh& skin, HandSide side);
Result<HandRig> hand_rig_from_skin(const SkinnedMesh& skin, HandSide side);

}  // namespace handhold

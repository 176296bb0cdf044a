#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "systems/rigs/body_rig.hpp"
#include "systems/rigs/hand_joint_names.hpp"

// Guesses the bone of a body from a joint's name.
namespace handhold {

// A bone of a body. `side` has a meaning only for limbs.
struct BodyJointName {
    BodyBone bone = BodyBone::trunk;  // trunk: the pelvis
    HandSide side = HandSide::left;
    bool operator==(const BodyJointName&) const = default;
};

struct BodyNameGuess {
    BodyJointName name;
    // 0: the name clearly means this bone ("UpperArm"). 1: it probably does, unless another joint's
    // name is clearer ("Arm", "Shoulder").
    int doubt = 0;
    // The bone that the joint is if another joint of the figure already is the bone `name`:
    // "Shoulder" is the upper arm if there is a scapula too, "Leg" the thigh if there is a knee.
    // Equal to `name` if the joint's name has only one meaning.
    BodyJointName other;
    // True: a twist or helper joint, which moves with the bone but is not the bone's first joint.
    bool is_part = false;
};

// Guesses the bone from the words of a joint's name. For example, "Bip01 L UpperArm",
// "mixamorig:LeftArm", "DEF-upper_arm.L", "lShldrBend" and "左腕" are upper arms, and
// "leftElbowPitchLink" is a forearm. Ignores case, separators, namespaces and numbers. Returns none
// for fingers, toes, faces, IK targets, end joints and names that mean no bone.
std::optional<BodyNameGuess> parse_body_joint_name(std::string_view name);

// True for the name of an eye: "LeftEye", "eye.L".
bool is_eye_name(const std::string& name);

// True for thumbs, fingers and toes.
bool is_digit_name(std::string_view name);

// True for the name of a joint that duplicates a deforming joint (Rigify's "ORG-" joints).
bool is_spare_name(std::string_view name);

// The bone's key in a BodyMap file, such as "left_upper_arm" or "pelvis".
std::string body_joint_text(const BodyJointName& joint);
// The key of a finger's joint, such as "left_index_proximal".
std::string finger_joint_text(HandSide side, FingerName finger, HandBone bone);

}  // namespace handhold

#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "systems/rigs/body_rig.hpp"

// What the names of joints say about a body.
namespace handhold {

// A bone of a body. `side` is meaningful for limbs only.
struct BodyJointName {
    BodyBone bone = BodyBone::trunk;  // trunk: the pelvis
    HandSide side = HandSide::left;
    bool operator==(const BodyJointName&) const = default;
};

struct BodyNameGuess {
    BodyJointName name;
    // 0: the name says this bone ("UpperArm"). 1: it does unless another joint's name says so more
    // clearly ("Arm", "Shoulder").
    int doubt = 0;
    // What the name means if `name` is another joint: with a scapula, "Shoulder" is the upper arm;
    // with a knee, "Leg" is the thigh. Equal to `name` if it has one meaning.
    BodyJointName other;
    // The joint moves with this bone but is not its first joint: a twist or helper joint.
    bool is_part = false;
};

// Reads the words of a joint's name: "Bip01 L UpperArm", "mixamorig:LeftArm", "DEF-upper_arm.L",
// "lShldrBend", "左腕" and "leftElbowPitchLink" are upper arms or elbows. Case, separators,
// namespaces and numbers do not count. Returns nothing for fingers, toes, faces, IK targets, end
// joints and names without a bone.
std::optional<BodyNameGuess> parse_body_joint_name(std::string_view name);

// True for thumbs, fingers and toes.
bool is_digit_name(std::string_view name);

// True for joints that repeat a deforming joint of the same name (Rigify's "ORG-").
bool is_spare_name(std::string_view name);

// "left_upper_arm", "pelvis": the keys of a map file.
std::string body_joint_text(const BodyJointName& joint);

}  // namespace handhold

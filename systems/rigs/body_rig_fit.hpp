#pragma once

#include "engine/core/result.hpp"
#include "engine/io/gltf_skin.hpp"
#include "systems/rigs/body_map.hpp"
#include "systems/rigs/body_rig.hpp"

// Fits body rigs to humanoid figures (load_gltf_figure) in T-pose or A-pose. Figures must be +Y up;
// their heading and size are arbitrary.
namespace handhold {

// Fits a body rig to a figure. Finds the bones first by the map, then by the joints' names
// (parse_body_joint_name), then by the joints' hierarchy and positions (fill_bones_by_shape).
//
// - Every joint follows a bone. A joint that is no bone itself follows the nearest limb, neck or
//   head above it; else the limb in its name; else the trunk at the joint's height.
// - Joints along a forearm follow a share of the hand's twist, by their position.
// - Joints named as hands, palms or fingers below a forearm follow the hand; joints of fingers that
//   are recognised (find_figure_fingers), and all below them, the shown hand's fingers. Two fingers
//   determine the hand's axes: wrist and knuckles lie as those of the built-in hand.
// - The trunk extends from a little above the hips to midway between the shoulders. Without thighs
//   it starts at the pelvis joint.
// - The eyes are at the joints named as eyes that follow the head, else at the front of the skin
//   that the head carries.
//
// Errors (the message names the joints or bones): missing head, upper arms, forearms or hands;
// implausible proportions (find_implausible_bone); joints in the map that do not exist; bones
// without length; figures that are not upright.
Result<BodyRig> fit_body_rig(const SkinnedMesh& figure, const BodyMap& map = {});
// fit_body_rig with known joints instead of a map. `names`: the caller's means of naming joints,
// for the message about joints that are not found.
struct BodyBones;
Result<BodyRig> fit_body_rig_with(const SkinnedMesh& figure, const BodyBones& mapped,
                                  const char* names = "a map");

}  // namespace handhold

#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "engine/io/gltf_skin.hpp"
#include "engine/io/result.hpp"
#include "systems/rigs/body_joint_names.hpp"
#include "systems/rigs/body_rig.hpp"

// Fits body rigs to humanoid figures (load_gltf_figure) in T-pose or A-pose. Figures must be +Y up;
// their heading and size are arbitrary.
namespace handhold {

// The user's assignment of bones to joints, for figures whose joint names do not determine them.
// Other bones are looked for among the joints that the map does not contain.
using BodyMap = std::map<std::string, std::string>;  // body_joint_text -> joint's name in the file
// Reads a file such as {"joints": {"pelvis": "Hips", "left_upper_arm": "arm_l_01"}}. Other keys,
// and values that are not text, are errors.
Result<BodyMap> load_body_map(const std::filesystem::path& path);
// The same from text in memory; `file` is used in messages.
Result<BodyMap> parse_body_map(std::string_view text, const std::string& file);

// Converts VRM's humanoid table (parse_vrm_humanoid). Omits bones that BodyBone does not have.
BodyMap body_map_of_vrm(const std::map<std::string, std::string>& humanoid);

// Fits a body rig to a figure. Finds the bones first by the map, then by the joints' names
// (parse_body_joint_name), then by the joints' hierarchy and positions (fill_bones_by_shape).
//
// - Every joint follows a bone. A joint that is no bone itself follows the nearest limb, neck or
//   head above it; else the limb in its name; else the trunk at the joint's height.
// - Joints along a forearm follow a share of the hand's twist, by their position.
// - Joints named as hands, palms or fingers below a forearm follow the hand.
// - The trunk extends from a little above the hips to midway between the shoulders. Without thighs
//   it starts at the pelvis joint.
// - The eyes are at the joints named as eyes that follow the head, else at the front of the skin
//   that the head carries.
//
// Errors (the message names the joints or bones): missing head, upper arms, forearms or hands;
// implausible proportions (find_implausible_bone); joints in the map that do not exist; bones
// without length; figures that are not upright.
Result<BodyRig> fit_body_rig(const SkinnedMesh& figure, const BodyMap& map = {});

}  // namespace handhold

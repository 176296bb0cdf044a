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

// Fits body rigs to humanoid figures (load_gltf_figure) in T-pose or A-pose, +Y up, with any
// heading and of any size.
namespace handhold {

// Joints of bones that names do not determine. Bones that are not in the map are found among the
// joints that are not in it.
using BodyMap = std::map<std::string, std::string>;  // body_joint_text -> name in the file
// Reads {"joints": {"pelvis": "Hips", "left_upper_arm": "arm_l_01"}}. Refuses other keys and values
// that are not text.
Result<BodyMap> load_body_map(const std::filesystem::path& path);
// Reads text in memory; `file` is for messages.
Result<BodyMap> parse_body_map(std::string_view text, const std::string& file);

// The bones of VRM's humanoid table (parse_vrm_humanoid) that a body has.
BodyMap body_map_of_vrm(const std::map<std::string, std::string>& humanoid);

// Finds the bones: first by the map, then by the joints' names (parse_body_joint_name), then by
// hierarchy and place (fill_bones_by_shape).
//
// Every joint follows a bone. Joints without a bone of their own follow the limb, neck or head
// above them, the limb that their name says, or else the trunk at their height. Joints on a forearm
// follow the hand's twist by their place. Hands, palms and fingers below a forearm follow the hand.
// The trunk extends from a little above the hips (from the pelvis joint if there are no thighs) to
// midway between the shoulders. The eyes are at the head's joints of that name, else at the front
// of the skin that the head carries.
//
// Refused, with the names and the option for a map: missing heads, shoulders, elbows or hands;
// proportions that no body has (find_implausible_bone); joints of the map that do not exist; bones
// without length; figures that are not upright.
Result<BodyRig> fit_body_rig(const SkinnedMesh& figure, const BodyMap& map = {});

}  // namespace handhold

#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>

#include "engine/core/result.hpp"

namespace handhold {

// The user's assignment of bones to joints, for figures whose joint names do not determine them.
// Other bones are looked for among the joints that the map does not contain.
using BodyMap = std::map<std::string, std::string>;  // body_joint_text or finger_joint_text ->
                                                     // joint's name in the file
// Reads a file such as {"joints": {"pelvis": "Hips", "left_upper_arm": "arm_l_01"}}. Other keys,
// and values that are not text, are errors.
Result<BodyMap> load_body_map(const std::filesystem::path& path);
// load_body_map for text in memory; `file` is used in messages.
Result<BodyMap> parse_body_map(std::string_view text, const std::string& file);

// Converts VRM's humanoid table (parse_vrm_humanoid). Omits bones that BodyBone does not have.
BodyMap body_map_of_vrm(const std::map<std::string, std::string>& humanoid);

}  // namespace handhold

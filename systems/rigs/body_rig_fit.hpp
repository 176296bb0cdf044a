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

// Body rigs out of any humanoid figure (load_gltf_figure): in T-pose or A-pose, +Y up, facing
// either way, of any size and proportions.
namespace handhold {

// Which joint is which bone, where names do not tell it; what it leaves out is found by name among
// the other joints.
using BodyMap = std::map<std::string, std::string>;  // body_joint_text -> name in the file
// {"joints": {"pelvis": "Hips", "left_upper_arm": "arm_l_01"}}. Refused: other keys, joints that
// are no text.
Result<BodyMap> load_body_map(const std::filesystem::path& path);
// The same for text in memory; `file` is for messages.
Result<BodyMap> parse_body_map(std::string_view text, const std::string& file);

// The bones of VRM's humanoid table (parse_vrm_humanoid) that a body has.
BodyMap body_map_of_vrm(const std::map<std::string, std::string>& humanoid);

// Of several joints whose names are alike the one nearest to the root is taken, but of a hip's the
// last above the knee, and a shoulder's last where no upper arm is named. What hangs on a forearm
// and is called hand, palm or finger goes with the hand; other joints that are no bones go with the
// limb above them, or with the trunk where they are; those on a forearm twist with the hand. The
// trunk goes from a little above the hips
// (the pelvis counts only where there are no thighs) to between the shoulders. The eyes are where
// the head's joints of that name are, else in front of the middle of what the head carries.
//
// Refused, with the names: a head, shoulders, elbows or hands that are missing; a map's name that
// is no joint's; bones without a length; figures that are not upright.
Result<BodyRig> fit_body_rig(const SkinnedMesh& figure, const BodyMap& map = {});

}  // namespace handhold

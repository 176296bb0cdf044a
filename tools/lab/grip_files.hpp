#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "components/hand_rig.hpp"
#include "engine/core/result.hpp"
#include "engine/io/json.hpp"
#include "tools/lab/grip_run.hpp"

// File formats of `handhold-lab grip`.
namespace handhold::lab {

// Reads one JSON value a line; blank lines are skipped. The first error of a value ends the reading
// and names the line.
std::optional<FileError> read_json_lines(const std::filesystem::path& path,
                                         const std::function<void(const JsonValue&)>& read);

struct Placement {
    std::int64_t id = 0;
    Pose wrist;  // wrist in the mesh's frame
};

// One JSON object per line: {"id": 0, "wrist": {"position_m": [3], "rotation_xyzw": [4]}}. Ignores
// other members. Errors name the line.
Result<std::vector<Placement>> load_placements(const std::filesystem::path& path);

// One line of the output, with line break.
std::string posed_hand_line(std::int64_t id, const HandRig& rig, const PosedHand& posed);

// Costs of hands that reuse results (warm), and counts of jumping joints, for every frame of every
// hand.
std::string warm_hands_json(const WarmHand& all);

// The rig as JSON, for external measuring tools: every field of HandRig except its skin's joints.
std::string hand_rig_json(const HandRig& rig);

}  // namespace handhold::lab

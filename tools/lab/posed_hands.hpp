#pragma once

#include <array>
#include <filesystem>
#include <string_view>
#include <vector>

#include "components/hand_rig.hpp"
#include "engine/core/result.hpp"
#include "tools/lab/hand_viewpoint.hpp"

namespace handhold::lab {

// The part of an output line of `handhold-lab grip` that pictures need. Poses are in the mesh's
// frame.
struct DrawnHand {
    std::int64_t id = 0;
    Pose wrist;  // shown wrist
    std::vector<HandCapsule> capsules;
    // Joint angles for the game's hand, indexed by FingerName. Angles missing in the line are 0.
    std::array<FingerAngles, k_finger_count> angles;
};

// Skips blank lines. Errors name the line and the JSON pointer.
Result<std::vector<DrawnHand>> parse_posed_hands(std::string_view text, const std::string& file);
Result<std::vector<DrawnHand>> load_posed_hands(const std::filesystem::path& path);

}  // namespace handhold::lab

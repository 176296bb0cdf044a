#pragma once

#include <array>
#include <filesystem>
#include <string_view>
#include <vector>

#include "components/hand_rig.hpp"
#include "engine/core/result.hpp"
#include "tools/lab/hand_viewpoint.hpp"

namespace handhold::lab {

// One line of the output of `handhold-lab grip`, as far as pictures need it. Poses are in the
// mesh's frame.
struct DrawnHand {
    std::int64_t id = 0;
    Pose wrist;  // shown wrist
    std::vector<HandCapsule> capsules;
    // Joint angles of the game's hand, by FingerName. Angles that the line does not give are 0.
    std::array<FingerAngles, k_finger_count> angles;
};

// Skips blank lines. Errors name the line and the JSON pointer.
Result<std::vector<DrawnHand>> parse_posed_hands(std::string_view text, const std::string& file);
Result<std::vector<DrawnHand>> load_posed_hands(const std::filesystem::path& path);

}  // namespace handhold::lab

#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <vector>

#include "components/arm.hpp"
#include "engine/core/result.hpp"
#include "engine/math/math.hpp"

// Input of `handhold-lab body`: poses of heads and hands over time, and body measures.
namespace handhold::lab {

struct BodySample {
    std::int64_t clip = 0;
    double t_s = 0.0;  // increases within a clip
    Pose head_ps;      // point between the eyes
    std::array<Pose, k_hand_count> hands_ps;
    std::array<bool, k_hand_count> is_lost = {};  // indexed by HandSide; the hand has no pose then
};

// Lines of 23 numbers: clip, t, then head, left and right hand as x, y, z, qx, qy, qz, qw. A hand
// of seven NaN is lost.
Result<std::vector<BodySample>> load_body_samples(const std::filesystem::path& path);

// Body measures; the key is the clip. The table may have text cells: only the columns clip,
// eye_height, upper_arm, forearm and shoulder_width are read. A person with an empty one was not
// measured: nullopt.
using MeasuresOfClips = std::map<std::int64_t, std::optional<BodyMeasures>>;
Result<MeasuresOfClips> load_body_measures(const std::filesystem::path& path);

}  // namespace handhold::lab

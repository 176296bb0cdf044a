#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/core/result.hpp"
#include "engine/math/math.hpp"

// `handhold-lab recorded-grips`: how gripping wrists move against what they hold in recorded play,
// and what hands cost in those frames.
namespace handhold::lab {

inline constexpr double k_recorded_hz = 90.0;

// One grip of one hand: from the frame in which it began to the last one.
struct RecordedGrip {
    std::string recording;
    std::string hand;  // "left" or "right"
    // By frame: the tracked wrist in the gripped body's frame, relative to the first frame's wrist;
    // a left hand's is mirrored. The first one is the identity.
    std::vector<Pose> wrists;
    // By frame: thread CPU time from gather_surroundings to fit_hands, microseconds for each of the
    // player's gripping hands.
    std::vector<double> us;
};

struct RecordedGripsOptions {
    std::string scene;
    std::vector<std::string> inputs;
    std::filesystem::path out;
};

// Writes one line per grip and prints the distributions. Exit status: 0, or 2 with one line on
// standard error if a file cannot be read or written.
int recorded_grips_command(const RecordedGripsOptions& options);

// Reads the lines of `recorded-grips`. Errors name the line.
Result<std::vector<RecordedGrip>> load_recorded_grips(const std::filesystem::path& path);

// `count` stretches of `frames` successive wrists, spread evenly over all stretches of the grips;
// each is relative to its own first wrist. Empty if no grip is as long as that. `frames` > 0.
std::vector<std::vector<Pose>> wrist_motions(const std::vector<RecordedGrip>& grips,
                                             std::size_t frames, std::size_t count);

}  // namespace handhold::lab

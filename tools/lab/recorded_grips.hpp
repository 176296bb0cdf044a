#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/core/result.hpp"
#include "engine/math/math.hpp"

// `handhold-lab recorded-grips`: measures how gripping wrists move relative to the gripped body in
// recorded sessions, and the cost of the hand stages in those frames.
namespace handhold::lab {

inline constexpr double k_recorded_hz = 90.0;

// One grip of one hand: from the frame in which it began to the last one.
struct RecordedGrip {
    std::string recording;
    std::string hand;  // "left" or "right"
    // One pose per frame: the tracked wrist in the gripped body's frame, relative to the wrist of
    // the first frame (so the first pose is the identity). Poses of left hands are mirrored.
    std::vector<Pose> wrists;
    // One time per frame: thread CPU time of the hand stages from gather_surroundings to fit_hands,
    // divided by the number of the player's gripping hands.
    std::vector<double> us;
    // One value per frame: how deep the shown hand is in surfaces, at least 0.
    std::vector<double> thumb_depth_mm;
    std::vector<double> fingers_depth_mm;  // the deepest finger
    // One value per frame: the shown palm is behind the gripped mesh (is_behind).
    std::vector<bool> out_of_sight;
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

// Returns `count` motions of `frames` successive wrists, spread evenly over all such parts of the
// grips. A motion is relative to the wrist in the frame before it. Empty if no grip has more
// than `frames` frames. Precondition: `frames` > 0.
std::vector<std::vector<Pose>> wrist_motions(const std::vector<RecordedGrip>& grips,
                                             std::size_t frames, std::size_t count);

}  // namespace handhold::lab

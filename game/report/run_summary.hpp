#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "game/run/run_log.hpp"

// Figures of a whole run, for report.json and report.html.
namespace handhold {

// Statistics of a list of times. Percentiles are by nearest rank: the ceil(p n)-th smallest of n, a
// value that occurred. All 0 for an empty list.
struct TimeFigures {
    double median_us = 0.0;
    double p99_us = 0.0;
    double max_us = 0.0;
    double total_us = 0.0;
};
TimeFigures summarize_times(std::vector<double> times_us);

// Worst distance between a gripping hand and its anchor. The player can follow a single gripping
// hand exactly, so its error should be 0. With two gripping hands, changes of the tracked distance
// between them remain as errors.
struct HandErrorFigures {
    double one_hand_free_m = 0.0;  // frames in which one hand grips, without contacts and push-back
    double two_hands_m = 0.0;      // both hands grip, or did in the previous frame
    double any_m = 0.0;            // distance while at least one hand grips
};

struct PlayerFigures {
    std::string name;
    double mass_kg = 0.0;
    double path_m = 0.0;       // length of the origin's path, from the end of the first frame on
    double push_back_m = 0.0;  // worst frame
};

// Impulses summed over all frames.
struct MomentumFigures {
    hh_momentum sum{};
    // How far momentum is from being conserved. For each frame, takes the length of the sum over
    // receivers; sums these lengths over the frames, so that frames cannot cancel each other.
    // Divides by the summed lengths of all impulses; 0 if there were none.
    double linear_residual = 0.0;
    double angular_residual = 0.0;
};

// The figures of a run. A worst value is NaN if any of the values is NaN, so that a broken run does
// not look good.
struct RunSummary {
    std::vector<TimeFigures> stages;  // indexed as hh_stage_name
    TimeFigures frame;                // sum of a frame's stages
    std::uint64_t frames = 0;
    double duration_s = 0.0;  // simulated time
    // Frames stepped per second of wall time; 0 if no time was measured.
    double frames_per_s = 0.0;
    RunStats totals;          // sums of counters and fallbacks; nothing else is set
    double residual_m = 0.0;  // worst contact overlap
    // Error of the worst joint: distance between its two points, or distance beyond a slider's
    // limit.
    double joint_error_m = 0.0;
    double joint_error_rad = 0.0;  // worst joint: directions and angles
    HandErrorFigures hand_error;
    double push_back_m = 0.0;  // worst frame and player
    MomentumFigures momentum;
    std::vector<PlayerFigures> players;
};

// Preconditions: indices of players are valid in RunLog::player_names, and player_mass_kg has the
// same length.
RunSummary summarize_run(const RunLog& log);

// Summarises a run frame by frame without keeping frames, in constant memory. Its figures equal
// those of summarize_run, except that percentiles of times are within 1 %.
class RunTally {
  public:
    RunTally();
    void add(const FrameLog& frame);
    // Uses all fields of `log` except its frames. Preconditions: those of summarize_run.
    RunSummary finish(const RunLog& log) const;

  private:
    friend RunSummary summarize_run(const RunLog& log);

    // Counts of times in classes 1 % wide.
    struct Histogram {
        std::vector<std::uint64_t> counts;
        TimeFigures figures;  // maximum and sum
        void add(double time_us);
        TimeFigures finish(std::uint64_t total) const;
    };
    struct PlayerTally {
        PlayerFigures figures;
        std::optional<hh::Vec3> last_ws;
        std::array<bool, 2> gripped_before{};
    };
    // The residual of linear or angular momentum.
    struct MomentumTally {
        double error = 0.0;  // sum over frames of the length of the receivers' sum
        double given = 0.0;  // sum over frames and receivers of the impulse's length
        void add(std::span<const hh::Vec3, 4> frame, std::span<hh::Vec3, 4> sum);
        double residual() const { return given == 0.0 ? 0.0 : error / given; }
    };

    void add_all_but_times(const FrameLog& frame);
    RunSummary finish_all_but_times(const RunLog& log) const;

    RunSummary sum_;
    std::vector<PlayerTally> players_;
    MomentumTally linear_;
    MomentumTally angular_;
    std::vector<Histogram> stages_;  // indexed as hh_stage_name
    Histogram frame_;
};

// Formats as "0x0123456789abcdef".
std::string format_hash(std::uint64_t hash);

}  // namespace handhold

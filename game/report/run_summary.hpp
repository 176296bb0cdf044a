#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "components/stats.hpp"
#include "game/session/run_log.hpp"

// The figures of a whole run: report.json and report.html show the same ones.
namespace handhold {

// Of a list of times. Percentiles are by nearest rank: the ceil(p n)-th smallest of n, a value that
// occurred. All 0 of an empty list.
struct TimeFigures {
    double median_us = 0.0;
    double p99_us = 0.0;
    double max_us = 0.0;
    double total_us = 0.0;
};
TimeFigures summarize_times(std::vector<double> times_us);

// Worst distance of a gripping hand from its anchor, split by what the other constraints allow. A
// player alone on one hand can always follow it; two hands keep their distance only as well as they
// are tracked.
struct HandErrorFigures {
    double one_hand_free_m =
        0.0;  // exactly one hand grips, to the frame's end; no contacts, no push-back in it
    double two_hands_m = 0.0;  // both grip
    double any_m = 0.0;        // a hand grips
};

struct PlayerFigures {
    std::string name;
    double mass_kg = 0.0;
    double path_m = 0.0;       // length of the origin's path, from the end of the first frame
    double push_back_m = 0.0;  // worst of a frame
};

// Impulses summed over all frames.
struct MomentumFigures {
    MomentumLedger sum;
    // How far the receivers are from summing to zero: each frame's total, relative to all that was
    // given in the run. Frames cannot cancel each other. 0 where nothing was given.
    double linear_residual = 0.0;
    double angular_residual = 0.0;
};

// What is worst is NaN where one of its values is: a run that broke does not look good.
struct RunSummary {
    std::array<TimeFigures, static_cast<std::size_t>(Stage::count)> stages;
    TimeFigures frame;  // sum of the stages of a frame
    std::uint64_t frames = 0;
    double duration_s = 0.0;       // simulated
    double frames_per_s = 0.0;     // as fast as it went; 0 where no time was measured
    StageStats totals;             // counters and fallbacks only
    double residual_m = 0.0;       // worst contact overlap
    double joint_error_m = 0.0;    // worst joint, points and limits of sliders
    double joint_error_rad = 0.0;  // the same of directions and angles
    HandErrorFigures hand_error;
    double push_back_m = 0.0;  // worst of a frame and player
    MomentumFigures momentum;
    std::vector<PlayerFigures> players;
};

// Preconditions: indices of players lie in RunLog::player_names, and player_mass_kg is as long.
RunSummary summarize_run(const RunLog& log);

// Sums up a run frame by frame, where the frames are not kept: memory does not grow with the run.
// Its figures are those of summarize_run, but for percentiles of times, which are within 1 %.
class RunTally {
  public:
    RunTally();
    void add(const FrameLog& frame);
    // `log` for all but its frames. Preconditions as summarize_run.
    RunSummary finish(const RunLog& log) const;

  private:
    friend RunSummary summarize_run(const RunLog& log);

    // Counts of times in classes that are 1 % wide.
    struct Histogram {
        std::vector<std::uint64_t> counts;
        TimeFigures figures;  // largest and sum
        void add(double time_us);
        TimeFigures finish(std::uint64_t total) const;
    };
    struct PlayerTally {
        PlayerFigures figures;
        std::optional<Vec3> last_ws;
        std::array<bool, k_hand_count> gripped_before{};
    };
    // One kind of momentum.
    struct MomentumTally {
        double error = 0.0;  // of all frames' totals
        double given = 0.0;  // by all receivers in all frames
        void add(const std::array<Vec3, MomentumLedger::receiver_count>& frame,
                 std::array<Vec3, MomentumLedger::receiver_count>& sum);
        double residual() const { return given == 0.0 ? 0.0 : error / given; }
    };

    void add_all_but_times(const FrameLog& frame);
    RunSummary finish_all_but_times(const RunLog& log) const;

    RunSummary sum_;
    std::vector<PlayerTally> players_;
    MomentumTally linear_;
    MomentumTally angular_;
    std::array<Histogram, static_cast<std::size_t>(Stage::count)> stages_;
    Histogram frame_;
};

// "0x0123456789abcdef"
std::string format_hash(std::uint64_t hash);

}  // namespace handhold

#include "game/report/run_summary.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "engine/core/check.hpp"

namespace handhold {
namespace {

// std::max would drop a NaN on either side.
void keep_worst(double& worst, double value) {
    if (value > worst || std::isnan(value)) {
        worst = value;
    }
}

// The ceil(percent n / 100)-th smallest, in integers: 0.99 * 100 is not 99 in every rounding.
double nearest_rank(const std::vector<double>& sorted, std::size_t percent) {
    constexpr std::size_t k_hundred = 100;
    return sorted[(sorted.size() * percent + k_hundred - 1) / k_hundred - 1];
}

void summarize_stage_times(const RunLog& log, RunSummary& summary) {
    std::vector<double> whole_us(log.frames.size(), 0.0);
    for (std::size_t stage = 0; stage < summary.stages.size(); ++stage) {
        std::vector<double> times_us;
        times_us.reserve(log.frames.size());
        for (std::size_t i = 0; i < log.frames.size(); ++i) {
            times_us.push_back(log.frames[i].stats.stage_us[stage]);
            whole_us[i] += times_us.back();
        }
        summary.stages[stage] = summarize_times(std::move(times_us));
    }
    summary.frame = summarize_times(std::move(whole_us));
}

void add_counters(StageStats& totals, const StageStats& frame) {
    for (std::size_t i = 0; i < totals.fallbacks.size(); ++i) {
        totals.fallbacks[i] += frame.fallbacks[i];
    }
    totals.grab_onsets += frame.grab_onsets;
    totals.grabs_gripped += frame.grabs_gripped;
    totals.islands += frame.islands;
    totals.islands_pushed += frame.islands_pushed;
    totals.contacts += frame.contacts;
    totals.contact_rounds += frame.contact_rounds;
    totals.newton_iterations += frame.newton_iterations;
}

void add_hand_errors(HandErrorFigures& worst, const FrameLog& frame, const PlayerLog& player) {
    std::size_t gripping = 0;
    double error_m = 0.0;
    for (const HandLog& hand : player.hands) {
        if (hand.grip != 0) {
            ++gripping;
            keep_worst(error_m, hand.error_m);
        }
    }
    if (gripping == 0) {
        return;
    }
    keep_worst(worst.any_m, error_m);
    if (gripping == k_hand_count) {
        keep_worst(worst.two_hands_m, error_m);
    } else if (player.push_back_m == 0.0 && frame.stats.contacts == 0) {
        keep_worst(worst.one_hand_free_m, error_m);
    }
}

void summarize_players(const RunLog& log, RunSummary& summary) {
    HH_CHECK(log.player_mass_kg.size() == log.player_names.size(), "a mass for each player",
             log.player_mass_kg.size());
    for (std::size_t i = 0; i < log.player_names.size(); ++i) {
        summary.players.push_back({log.player_names[i], log.player_mass_kg[i]});
    }
    std::vector<std::optional<Vec3>> last_ws(log.player_names.size());
    for (const FrameLog& frame : log.frames) {
        for (const PlayerLog& player : frame.players) {
            HH_CHECK(player.player < last_ws.size(), "no player of this index", player.player);
            std::optional<Vec3>& last = last_ws[player.player];
            PlayerFigures& figures = summary.players[player.player];
            figures.path_m += last ? (player.origin_ws - *last).norm() : 0.0;
            last = player.origin_ws;
            keep_worst(figures.push_back_m, player.push_back_m);
            add_hand_errors(summary.hand_error, frame, player);
        }
    }
    for (const PlayerFigures& player : summary.players) {
        keep_worst(summary.push_back_m, player.push_back_m);
    }
}

// One kind of momentum over the run.
struct MomentumSum {
    double error = 0.0;  // of all frames' totals
    double given = 0.0;  // by all receivers in all frames

    void add(const std::array<Vec3, MomentumLedger::receiver_count>& frame,
             std::array<Vec3, MomentumLedger::receiver_count>& sum) {
        Vec3 total = Vec3::Zero();
        for (std::size_t i = 0; i < frame.size(); ++i) {
            sum[i] += frame[i];
            total += frame[i];
            given += frame[i].norm();
        }
        error += total.norm();
    }
    double residual() const { return given == 0.0 ? 0.0 : error / given; }
};

void summarize_momentum(const RunLog& log, MomentumFigures& figures) {
    MomentumSum linear;
    MomentumSum angular;
    for (const FrameLog& frame : log.frames) {
        linear.add(frame.stats.ledger.linear_kgmps, figures.sum.linear_kgmps);
        angular.add(frame.stats.ledger.angular_kgm2ps, figures.sum.angular_kgm2ps);
    }
    figures.linear_residual = linear.residual();
    figures.angular_residual = angular.residual();
}

}  // namespace

TimeFigures summarize_times(std::vector<double> times_us) {
    constexpr std::size_t k_median = 50;
    constexpr std::size_t k_high = 99;
    if (times_us.empty()) {
        return {};
    }
    std::sort(times_us.begin(), times_us.end());
    return {nearest_rank(times_us, k_median), nearest_rank(times_us, k_high), times_us.back(),
            std::accumulate(times_us.begin(), times_us.end(), 0.0)};
}

RunSummary summarize_run(const RunLog& log) {
    RunSummary summary;
    summarize_stage_times(log, summary);
    summarize_players(log, summary);
    summarize_momentum(log, summary.momentum);
    for (const FrameLog& frame : log.frames) {
        add_counters(summary.totals, frame.stats);
        keep_worst(summary.residual_m, frame.stats.residual_m);
    }
    const auto frames = static_cast<double>(log.frames.size());
    summary.duration_s = frames / log.hz;
    summary.frames_per_s = log.wall_s > 0.0 ? frames / log.wall_s : 0.0;
    return summary;
}

std::string format_hash(std::uint64_t hash) {
    constexpr char k_digits[] = "0123456789abcdef";
    constexpr int k_bits_per_digit = 4;
    std::string text = "0x";
    for (int shift = 60; shift >= 0; shift -= k_bits_per_digit) {
        text += k_digits[(hash >> static_cast<unsigned>(shift)) & 15U];
    }
    return text;
}

}  // namespace handhold

#include "game/report/run_summary.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <handhold/math.hpp>

#include "engine/core/check.hpp"

namespace handhold {
namespace {

// Sets `worst` to the larger value. Unlike std::max, keeps a NaN in either of them.
void keep_worst(double& worst, double value) {
    if (value > worst || std::isnan(value)) {
        worst = value;
    }
}

// The ceil(percent * n / 100)-th smallest of n values. Computed in integers, because 0.99 * 100 may
// round below 99.
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

void add_counters(RunStats& totals, const RunStats& frame) {
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

// A hand counts as gripping if it grips in this frame or did in the previous one, because a hand
// that releases holds until the frame's end.
void add_hand_errors(const FrameLog& frame, const PlayerLog& player,
                     std::array<bool, 2>& gripped_before, HandErrorFigures& worst) {
    std::size_t gripping = 0;
    double error_m = 0.0;
    for (std::size_t side = 0; side < 2; ++side) {
        const HandLog& hand = player.hands[side];
        const bool grips = hand.grip != 0;
        gripping += grips || gripped_before[side] ? 1U : 0U;
        keep_worst(error_m, grips ? hand.error_m : 0.0);
        gripped_before[side] = grips;
    }
    keep_worst(worst.any_m, error_m);
    if (gripping == 2) {
        keep_worst(worst.two_hands_m, error_m);
    } else if (player.push_back_m == 0.0 && frame.stats.contacts == 0) {
        keep_worst(worst.one_hand_free_m, error_m);
    }
}

// Class i counts times from k_first_us * 1.01^i to k_first_us * 1.01^(i + 1). Class 0 also counts
// all shorter times.
constexpr double k_first_us = 0.01;
constexpr double k_class_width = 1.01;
constexpr std::size_t k_classes = 2400;  // the last class is at minutes

std::size_t class_of(double time_us) {
    if (!(time_us > k_first_us)) {
        return 0;
    }
    const double at = std::log(time_us / k_first_us) / std::log(k_class_width);
    return std::min(static_cast<std::size_t>(at), k_classes - 1);
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

void RunTally::Histogram::add(double time_us) {
    ++counts[class_of(time_us)];
    figures.max_us = std::max(figures.max_us, time_us);
    figures.total_us += time_us;
}

TimeFigures RunTally::Histogram::finish(std::uint64_t total) const {
    TimeFigures out = figures;
    constexpr std::uint64_t k_hundred = 100;
    std::uint64_t seen = 0;
    bool median_known = false;
    for (std::size_t i = 0; i < counts.size() && seen < total; ++i) {
        seen += counts[i];
        // The middle of the class: at most 0.5 % from any time in it.
        const double time_us = k_first_us * std::pow(k_class_width, static_cast<double>(i) + 0.5);
        if (!median_known && k_hundred * seen >= 50 * total) {
            out.median_us = time_us;
            median_known = true;
        }
        if (k_hundred * seen >= 99 * total) {
            out.p99_us = time_us;
            break;
        }
    }
    return out;
}

void RunTally::MomentumTally::add(std::span<const hh::Vec3, 4> frame, std::span<hh::Vec3, 4> sum) {
    hh::Vec3 total{};
    for (std::size_t i = 0; i < frame.size(); ++i) {
        sum[i] += frame[i];
        total += frame[i];
        given += hh::length(frame[i]);
    }
    error += hh::length(total);
}

RunTally::RunTally() {
    frame_.counts.assign(k_classes, 0);
    stages_.assign(sum_.totals.stage_us.size(), frame_);
    sum_.stages.resize(stages_.size());
}

void RunTally::add(const FrameLog& frame) {
    add_all_but_times(frame);
    double whole_us = 0.0;
    for (std::size_t stage = 0; stage < stages_.size(); ++stage) {
        stages_[stage].add(frame.stats.stage_us[stage]);
        whole_us += frame.stats.stage_us[stage];
    }
    frame_.add(whole_us);
}

void RunTally::add_all_but_times(const FrameLog& frame) {
    ++sum_.frames;
    add_counters(sum_.totals, frame.stats);
    keep_worst(sum_.residual_m, frame.stats.residual_m);
    keep_worst(sum_.joint_error_m, frame.stats.joint_error_m);
    keep_worst(sum_.joint_error_rad, frame.stats.joint_error_rad);
    linear_.add(frame.stats.momentum.linear_kgmps, sum_.momentum.sum.linear_kgmps);
    angular_.add(frame.stats.momentum.angular_kgm2ps, sum_.momentum.sum.angular_kgm2ps);
    for (const PlayerLog& player : frame.players) {
        players_.resize(std::max<std::size_t>(players_.size(), player.player + 1));
        PlayerTally& tally = players_[player.player];
        tally.figures.path_m += tally.last_ws ? hh::length(player.origin_ws - *tally.last_ws) : 0.0;
        tally.last_ws = player.origin_ws;
        keep_worst(tally.figures.push_back_m, player.push_back_m);
        add_hand_errors(frame, player, tally.gripped_before, sum_.hand_error);
    }
}

RunSummary RunTally::finish(const RunLog& log) const {
    RunSummary summary = finish_all_but_times(log);
    for (std::size_t stage = 0; stage < stages_.size(); ++stage) {
        summary.stages[stage] = stages_[stage].finish(sum_.frames);
    }
    summary.frame = frame_.finish(sum_.frames);
    return summary;
}

RunSummary RunTally::finish_all_but_times(const RunLog& log) const {
    HH_CHECK(log.player_mass_kg.size() == log.player_names.size(), "a mass for each player",
             log.player_mass_kg.size());
    HH_CHECK(players_.size() <= log.player_names.size(), "no player of this index",
             players_.size() - 1);
    RunSummary summary = sum_;
    for (std::size_t i = 0; i < log.player_names.size(); ++i) {
        PlayerFigures figures = i < players_.size() ? players_[i].figures : PlayerFigures{};
        figures.name = log.player_names[i];
        figures.mass_kg = log.player_mass_kg[i];
        keep_worst(summary.push_back_m, figures.push_back_m);
        summary.players.push_back(std::move(figures));
    }
    summary.momentum.linear_residual = linear_.residual();
    summary.momentum.angular_residual = angular_.residual();
    const auto frames = static_cast<double>(summary.frames);
    summary.duration_s = frames / log.hz;
    summary.frames_per_s = log.wall_s > 0.0 ? frames / log.wall_s : 0.0;
    return summary;
}

RunSummary summarize_run(const RunLog& log) {
    RunTally tally;
    for (const FrameLog& frame : log.frames) {
        tally.add_all_but_times(frame);
    }
    RunSummary summary = tally.finish_all_but_times(log);
    summarize_stage_times(log, summary);
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

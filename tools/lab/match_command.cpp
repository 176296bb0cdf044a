#include "tools/lab/match_command.hpp"

#include <cstdio>
#include <numeric>

#include <nlohmann/json.hpp>

#include "engine/core/parallel.hpp"
#include "engine/core/text_file.hpp"
#include "tools/lab/exit_status.hpp"
#include "tools/lab/match_run.hpp"
#include "tools/lab/socket_match_command.hpp"

namespace handhold::lab {
namespace {

using Json = nlohmann::ordered_json;
constexpr int k_exit_differs = 3;
constexpr double k_mm_per_m = 1000.0;

double mean_of(const Series& series) {
    return series.values.empty()
               ? 0.0
               : std::accumulate(series.values.begin(), series.values.end(), 0.0) /
                     static_cast<double>(series.values.size());
}
Json spread_of(const Series& series) {
    return {
        {"median", series.quantile(0.5)}, {"p99", series.quantile(0.99)}, {"max", series.max()}};
}
Json mean_and_p99_of(const Series& series) {
    return {{"mean", mean_of(series)}, {"p99", series.quantile(0.99)}};
}

// A tick's motion beyond the true one.
Json jumps_of(const Series& stepped, const Series& shown) {
    return {{"ticks", stepped.values.size()},
            {"stepped_p99", k_mm_per_m * stepped.quantile(0.99)},
            {"shown_p99", k_mm_per_m * shown.quantile(0.99)},
            {"stepped_max", k_mm_per_m * stepped.max()},
            {"shown_max", k_mm_per_m * shown.max()}};
}

Json json_of(const MatchOptions& options, const MatchFigures& figures) {
    const double filled_share =
        figures.asked > 0 ? static_cast<double>(figures.filled) / static_cast<double>(figures.asked)
                          : 0.0;
    return {
        {"scene", options.scene},
        {"peers", options.peers},
        {"network",
         {{"rtt_ms", options.rtt_ms},
          {"jitter_ms", options.jitter_ms},
          {"loss", options.loss},
          {"burst_loss", options.burst_loss},
          {"duplicate", options.duplicate},
          {"kbps", options.kbps},
          {"packets_per_tick", options.packets},
          {"overhead_bytes", options.overhead_bytes},
          {"seed", options.seed}}},
        {"ticks", figures.ticks},
        {"confirmed_ticks", figures.confirmed_ticks},
        {"hashes_compared", figures.hashes_compared},
        {"hashes_different", figures.hashes_different},
        {"stalls", figures.stalls},
        {"filled_share", filled_share},
        {"rollback",
         {{"ticks", spread_of(figures.rollback_ticks)}, {"us", spread_of(figures.rollback_us)}}},
        {"tick_us_client", spread_of(figures.client_tick_us)},
        {"tick_us_server", spread_of(figures.server_tick_us)},
        {"kbps_up", mean_and_p99_of(figures.up_kbps)},
        {"kbps_down", mean_and_p99_of(figures.down_kbps)},
        {"input_bytes", mean_and_p99_of(figures.input_bytes)},
        {"largest_packet_bytes", figures.largest_packet},
        {"others_age_ms",
         {{"median", k_mm_per_m * figures.others_age_s.quantile(0.5)},
          {"p95", k_mm_per_m * figures.others_age_s.quantile(0.95)}}},
        {"others_hand_error_mm",
         {{"median", k_mm_per_m * figures.others_hand_m.quantile(0.5)},
          {"p95", k_mm_per_m * figures.others_hand_m.quantile(0.95)}}},
        {"others_shown_error_mm",
         {{"median", k_mm_per_m * figures.others_shown_m.quantile(0.5)},
          {"p95", k_mm_per_m * figures.others_shown_m.quantile(0.95)}}},
        {"beyond_true_motion_mm",
         {{"own_view", jumps_of(figures.own_view_raw_m, figures.own_view_m)},
          {"own_view_shared_load",
           jumps_of(figures.own_view_shared_raw_m, figures.own_view_shared_m)},
          {"others_hands", jumps_of(figures.others_jump_raw_m, figures.others_jump_m)}}},
        {"grips", figures.holds.grips},
        {"shared_holds", figures.holds.shared_holds},
        {"throws", figures.holds.throws},
        {"player_holds", figures.holds.player_holds}};
}

// What a run must have to prove anything; null: it has all.
const char* missing_in(const MatchFigures& figures, const MatchSetting& setting) {
    if (figures.hashes_compared == 0 || figures.holds.grips == 0 ||
        figures.rollback_ticks.values.empty()) {
        return "nobody gripped, went back or compared a hash";
    }
    if (setting.scene != "together") {
        return nullptr;
    }
    bool shares = false;
    bool holds_players = false;
    for (std::size_t pair = 0; pair < setting.players / 2; ++pair) {
        const bool is_hold = task_of_pair(setting, pair) == PairTask::hold_each_other;
        holds_players = holds_players || is_hold;
        shares = shares || !is_hold;
    }
    if (figures.holds.throws == 0) {
        return "nobody threw";
    }
    if (shares && figures.holds.shared_holds == 0) {
        return "no two players held one body";
    }
    return holds_players && figures.holds.player_holds == 0 ? "nobody held another player"
                                                            : nullptr;
}

}  // namespace

int match_command(const MatchOptions& options) {
    const NetworkTraits network = {.delay_s = 0.0005 * options.rtt_ms,
                                   .jitter_s = 0.001 * options.jitter_ms,
                                   .loss = options.loss,
                                   .duplication = options.duplicate,
                                   .burst_loss = options.burst_loss,
                                   .bytes_per_s = 125.0 * options.kbps,
                                   .overhead_bytes = options.overhead_bytes};
    if (!options.sockets.empty()) {
        return socket_match_command({options.sockets, options.peers, options.transport, network,
                                     options.seconds, options.freeze_s, options.seed},
                                    options.json);
    }
    if ((options.scene == "recorded") == options.inputs.empty()) {
        std::fprintf(stderr,
                     "handhold-lab: --input: expected with --scene recorded, and only there\n");
        return k_exit_usage;
    }
    set_thread_count(options.threads);
    MatchRunOptions run;
    run.setting.scene = options.scene;
    run.setting.players = static_cast<std::size_t>(options.peers);
    run.setting.first_pair = static_cast<std::size_t>(options.first_pair);
    for (const std::filesystem::path& input : options.inputs) {
        Result<Recording> recording = load_recording(input);
        if (!recording) {
            return refuse(recording.error());
        }
        run.setting.recordings.push_back(std::move(recording.value()));
    }
    run.network = network;
    run.seconds = options.seconds;
    run.packets_per_tick = options.packets;
    run.seed = options.seed;
    const MatchFigures figures = run_match(run);
    if (const auto error =
            write_file_atomically(options.json, json_of(options, figures).dump(2) + "\n")) {
        return refuse(*error);
    }
    if (figures.hashes_different > 0) {
        std::fprintf(stderr, "handhold-lab: %llu of %llu hashes differ\n",
                     static_cast<unsigned long long>(figures.hashes_different),
                     static_cast<unsigned long long>(figures.hashes_compared));
        return k_exit_differs;
    }
    if (const char* const fault = missing_in(figures, run.setting)) {
        std::fprintf(stderr, "handhold-lab: %s\n", fault);
        return k_exit_differs;
    }
    return 0;
}

}  // namespace handhold::lab

#include "game/report/report_json.hpp"

#include <array>

#include <nlohmann/json.hpp>

#include "engine/core/text_file.hpp"
#include "game/report/run_summary.hpp"
#include "game/report/text.hpp"

namespace handhold {
namespace {

// Keys keep their order of insertion: people read this file too.
using Json = nlohmann::ordered_json;

constexpr std::array<const char*, HH_MOMENTUM_RECEIVERS> k_receivers = {
    "objects", "players", "virtual_player", "statics"};

Json to_json(const hh::Vec3& v) { return Json::array({v.x, v.y, v.z}); }

Json to_json(const TimeFigures& figures) {
    return {{"median", figures.median_us}, {"p99", figures.p99_us}, {"max", figures.max_us}};
}

Json list_stages(const RunSummary& summary) {
    Json stages = Json::object();
    for (std::size_t i = 0; i < summary.stages.size(); ++i) {
        stages[hh_stage_name(i)] = to_json(summary.stages[i]);
    }
    return stages;
}

Json list_counters(const RunStats& totals) {
    Json fallbacks = Json::object();
    for (std::size_t i = 0; i < totals.fallbacks.size(); ++i) {
        fallbacks[hh_fallback_name(i)] = totals.fallbacks[i];
    }
    return {
        {"fallbacks", std::move(fallbacks)},       {"islands", totals.islands},
        {"islands_pushed", totals.islands_pushed}, {"contacts", totals.contacts},
        {"contact_rounds", totals.contact_rounds}, {"newton_iterations", totals.newton_iterations}};
}

Json describe_momentum(const MomentumFigures& momentum) {
    Json linear = Json::object();
    Json angular = Json::object();
    for (std::size_t i = 0; i < k_receivers.size(); ++i) {
        linear[k_receivers[i]] = to_json(momentum.sum.linear_kgmps[i]);
        angular[k_receivers[i]] = to_json(momentum.sum.angular_kgm2ps[i]);
    }
    return {{"linear_kgmps", std::move(linear)},
            {"angular_kgm2ps", std::move(angular)},
            {"relative_residual",
             {{"linear", momentum.linear_residual}, {"angular", momentum.angular_residual}}}};
}

Json list_players(const RunSummary& summary) {
    Json players = Json::array();
    for (const PlayerFigures& player : summary.players) {
        players.push_back({{"name", player.name},
                           {"mass_kg", player.mass_kg},
                           {"path_m", player.path_m},
                           {"push_back_mm", player.push_back_m * k_mm_in_m}});
    }
    return players;
}

}  // namespace

std::string format_report_json(const RunLog& log) {
    const RunSummary summary = summarize_run(log);
    Json report;
    report["scene"] = log.scene;
    report["input"] = log.input;
    report["spawn"] = log.spawn;
    report["hz"] = log.hz;
    report["threads"] = log.threads;
    report["frames"] = log.frames.size();
    report["duration_s"] = summary.duration_s;
    report["wall_s"] = log.wall_s;
    report["frames_per_second"] = summary.frames_per_s;
    report["stage_us"] = list_stages(summary);
    report["frame_us"] = to_json(summary.frame);
    report["counters"] = list_counters(summary.totals);
    report["residual_mm"] = summary.residual_m * k_mm_in_m;
    report["joint_error"] = {{"mm", summary.joint_error_m * k_mm_in_m},
                             {"rad", summary.joint_error_rad}};
    report["hand_error_mm"] = {{"one_hand_free", summary.hand_error.one_hand_free_m * k_mm_in_m},
                               {"two_hands", summary.hand_error.two_hands_m * k_mm_in_m},
                               {"any", summary.hand_error.any_m * k_mm_in_m}};
    report["push_back_mm"] = summary.push_back_m * k_mm_in_m;
    report["momentum_ledger"] = describe_momentum(summary.momentum);
    report["grabs"] = {{"onsets", summary.totals.grab_onsets},
                       {"gripped", summary.totals.grabs_gripped}};
    report["path_m"] = summary.players.empty() ? 0.0 : summary.players.front().path_m;
    report["bytes_per_player"] = log.bytes_per_player;
    report["players"] = list_players(summary);
    report["state_hash"] = format_hash(log.state_hash);
    constexpr int k_indent = 2;
    return report.dump(k_indent, ' ', false, Json::error_handler_t::replace) + '\n';
}

std::optional<FileError> write_report_json(const std::filesystem::path& path, const RunLog& log) {
    return write_file_atomically(path, format_report_json(log));
}

}  // namespace handhold

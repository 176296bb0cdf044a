#include "tools/lab/socket_match_command.hpp"

#include <cstdio>
#include <numeric>

#include <nlohmann/json.hpp>

#include "engine/core/parallel.hpp"
#include "game/session/interrupt.hpp"
#include "tools/lab/exit_status.hpp"

namespace handhold::lab {
namespace {

using Json = nlohmann::ordered_json;
constexpr int k_exit_differs = 3;
constexpr double k_mm_per_m = 1000.0;
constexpr double k_ms_per_s = 1000.0;

Json spread_of(const Series& series, double unit = 1.0) {
    return {{"median", unit * series.quantile(0.5)},
            {"p99", unit * series.quantile(0.99)},
            {"max", unit * series.max()}};
}
Json mean_and_p99_of(const Series& series) {
    const double sum = std::accumulate(series.values.begin(), series.values.end(), 0.0);
    const auto count = static_cast<double>(series.values.size());
    return {{"mean", count > 0.0 ? sum / count : 0.0}, {"p99", series.quantile(0.99)}};
}
double share(std::uint64_t part, std::uint64_t whole) {
    return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0.0;
}

Json network_json(const SocketMatchOptions& options) {
    return {{"rtt_ms", 2.0 * k_ms_per_s * options.network.delay_s},
            {"jitter_ms", k_ms_per_s * options.network.jitter_s},
            {"loss", options.network.loss},
            {"overhead_bytes", options.network.overhead_bytes},
            {"burst_loss", options.network.burst_loss},
            {"duplicate", options.network.duplication},
            {"transport", options.transport},
            {"seed", options.seed}};
}

Json json_of(const SocketMatchOptions& options, const SocketMatchFigures& figures) {
    return {
        {"scene", options.scene},
        {"peers", options.peers},
        {"network", network_json(options)},
        {"ticks", figures.ticks},
        {"confirmed_ticks", figures.confirmed_ticks},
        {"hashes_compared", figures.hashes_compared},
        {"hashes_different", figures.hashes_different},
        {"stalls", figures.stalls},
        {"states", figures.states},
        {"filled_share", share(figures.filled, figures.asked)},
        {"own_hand",
         {{"ticks", figures.own_hand_ticks},
          {"different", figures.own_hand_different},
          {"unexplained", figures.own_hand_unexplained}}},
        {"rollback",
         {{"ticks", spread_of(figures.rollback_ticks)}, {"us", spread_of(figures.rollback_us)}}},
        {"tick_us_client", spread_of(figures.client_us)},
        {"kbps_up", mean_and_p99_of(figures.up_kbps)},
        {"kbps_down", mean_and_p99_of(figures.down_kbps)},
        {"others_hand_error_mm",
         {{"median", k_mm_per_m * figures.others_hand_m.quantile(0.5)},
          {"p95", k_mm_per_m * figures.others_hand_m.quantile(0.95)}}},
        {"grips", figures.holds.grips},
        {"shared_holds", figures.holds.shared_holds},
        {"throws", figures.holds.throws},
        {"player_holds", figures.holds.player_holds},
        {"join_s", spread_of(figures.join_s)},
        {"freeze",
         {{"seconds", options.freeze_s},
          {"filled", figures.frozen_filled},
          {"others_frame_ms", spread_of(figures.others_frame_in_freeze_s, k_ms_per_s)},
          {"others_frame_ms_before_and_after", spread_of(figures.others_frame_s, k_ms_per_s)},
          {"others_ticks_per_s", figures.others_ticks_per_s_in_freeze}}},
        {"proxy",
         {{"pieces", figures.proxy.pieces},
          {"bytes", figures.proxy.bytes},
          {"lost", figures.proxy.lost},
          {"overtaken", figures.proxy.overtaken}}}};
}

// Null: the run proves what it claims.
const char* fault_of(const SocketMatchFigures& figures) {
    if (figures.hashes_different > 0) {
        return "hashes differ";
    }
    if (figures.own_hand_unexplained > 0) {
        return "own hands differ in more ticks than were filled";
    }
    if (figures.hashes_compared == 0 || figures.own_hand_ticks == 0) {
        return "nothing was compared";
    }
    if (figures.holds.grips == 0) {
        return "nobody gripped";
    }
    if (figures.rollbacks == 0) {
        return "nobody went back";
    }
    return figures.filled + figures.frozen_filled == 0 ? "no tick was filled" : nullptr;
}

}  // namespace

int socket_match_command(const SocketMatchOptions& options, const std::filesystem::path& json) {
    set_thread_count(1);
    const Result<SocketMatchFigures> figures = run_socket_match(options);
    if (!figures) {
        return refuse(figures.error());
    }
    if (const auto error =
            write_file_atomically(json, json_of(options, figures.value()).dump(2) + "\n")) {
        return refuse(*error);
    }
    if (const char* const fault = fault_of(figures.value())) {
        std::fprintf(stderr, "handhold-lab: %s\n", fault);
        return k_exit_differs;
    }
    return 0;
}

int proxy_command(const ProxyOptions& options) {
    const InterruptGuard interrupts;
    const Result<std::unique_ptr<SocketProxy>> opened =
        open_proxy(options.is_udp ? ProxyKind::udp : ProxyKind::tcp, options.server_port,
                   options.network, options.seed);
    if (!opened) {
        return refuse(opened.error());
    }
    SocketProxy& proxy = *opened.value();
    std::printf("%d\n", proxy.port());
    std::fflush(stdout);
    constexpr double k_look_s = 0.01;
    while (!is_interrupted()) {
        proxy.poll(k_look_s);
    }
    const auto number = [](std::uint64_t count) { return static_cast<unsigned long long>(count); };
    const ProxyCounts& counts = proxy.counts();
    std::printf("flows %llu pieces %llu bytes %llu lost %llu doubled %llu overtaken %llu\n",
                number(counts.flows), number(counts.pieces), number(counts.bytes),
                number(counts.lost), number(counts.doubled), number(counts.overtaken));
    return 0;
}

}  // namespace handhold::lab

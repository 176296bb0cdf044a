#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <utility>

#include "game/commands/match_commands.hpp"
#include "game/commands/match_entry.hpp"
#include "game/net/agones.hpp"
#include "game/net/match_scene.hpp"
#include "game/net/match_server.hpp"
#include "game/net/transport_kinds.hpp"
#include "game/play/exit_status.hpp"
#include "game/play/loading.hpp"
#include "game/report/run_summary.hpp"
#include "game/session/interrupt.hpp"

namespace handhold {
namespace {

constexpr double k_drain_within_s = 3.0;
constexpr std::uint64_t k_hash_log_ticks = 180;

double steady_s() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

Result<MatchServerSettings> choose_server_settings(const ServeOptions& options, MatchScene& scene) {
    MatchServerSettings settings;
    settings.offer.scene = scene.scene.name.substr(0, k_most_text_bytes);
    settings.offer.seed = options.seed;
    settings.offer.digests = scene.digests;
    settings.tick_s = k_match_tick_s;
    settings.return_s = options.return_s;
    settings.spectators = static_cast<std::size_t>(options.spectators);
    settings.clock = steady_s;
    settings.today = [] { return static_cast<std::int64_t>(std::time(nullptr)); };
    settings.log = print_log_line;
    settings.arena = scene.scene.arena ? &*scene.scene.arena : nullptr;
    if (!options.token_key.empty()) {
        Result<TokenKey> key = load_token_key(options.token_key);
        if (!key) {
            return key.error();
        }
        settings.key = std::move(key.value());
    }
    return settings;
}

void log_hash(const hh::Match& match, const Scene& scene, std::uint64_t& logged) {
    const std::uint64_t tick = match.stats().tick;
    if (tick > logged && tick % k_hash_log_ticks == 0) {
        logged = tick;
        print_log_line(
            log_line("confirmed", {{"tick", std::to_string(tick)},
                                   {"hash", format_hash(*match.hash(tick))},
                                   {"score", scene.arena ? score_text(scene.arena->state) : ""}}));
    }
}

// True once the match is over.
bool report_to_agones(const MatchServer& server, FleetMatch& fleet, AgonesReporter& agones) {
    const double now_s = steady_s();
    agones.beat();
    agones.set(fleet.update(server.seats(), now_s));
    return fleet.is_over(now_s);
}

// Until the options' time is over or the program is interrupted; then until all peers know.
void serve(const ServeOptions& options, const Scene& scene, MatchServer& server) {
    const double begin_s = steady_s();
    std::optional<AgonesReporter> agones;
    if (options.agones) {
        agones.emplace(agones_port(), print_log_line);
    }
    FleetMatch fleet(options.return_s);
    std::uint64_t logged = 0;
    while (!is_interrupted() &&
           (options.seconds == 0.0 || steady_s() - begin_s < options.seconds)) {
        server.poll();
        if (agones && report_to_agones(server, fleet, *agones)) {
            break;
        }
        log_hash(server.match(), scene, logged);
    }
    server.drain();
    const double drain_s = steady_s();
    while (!server.is_drained() && steady_s() - drain_s < k_drain_within_s) {
        server.poll();
    }
    if (agones) {
        agones->set(AgonesReporter::State::shutdown);
    }
}

void log_end(const Scene& scene, const MatchServer& server) {
    const hh_match_stats stats = server.match().stats();
    print_log_line(log_line("ends", {{"tick", std::to_string(stats.tick)},
                                     {"hash", format_hash(*server.match().hash(stats.tick))},
                                     {"score", scene.arena ? score_text(scene.arena->state) : ""},
                                     {"joins", std::to_string(server.counts().joins)},
                                     {"hashes", std::to_string(stats.hashes)},
                                     {"out_of_sync", std::to_string(stats.out_of_sync)}}));
}

}  // namespace

ListenerSettings listener_settings(const ServeOptions& options) {
    ListenerSettings out;
    out.address = options.address;
    out.port = options.port;
    out.certificate = options.certificate;
    out.key = options.key;
    // Links that say hello, or request /health or /metrics.
    constexpr std::size_t k_links_besides = 16;
    out.most_links =
        std::max(out.most_links,
                 static_cast<std::size_t>(options.players + options.spectators) + k_links_besides);
    return out;
}

int serve_command(const ServeOptions& options) {
    const InterruptGuard interrupts;
    const Result<std::unique_ptr<Listener>> listener = open_listener(listener_settings(options));
    if (!listener) {
        return refuse(listener.error());
    }
    Result<Scene> loaded = load_scene_with_progress(options.scene);
    if (!loaded) {
        return refuse(loaded.error());
    }
    print_notes(loaded.value().notes);
    Result<MatchScene> scene = make_match_scene(
        std::move(loaded.value()), static_cast<std::size_t>(options.players), options.seed);
    if (!scene) {
        return refuse(scene.error());
    }
    Result<MatchServerSettings> settings = choose_server_settings(options, scene.value());
    if (!settings) {
        return refuse(settings.error());
    }
    MatchOffer level = settings.value().offer;
    level.players = static_cast<std::uint8_t>(options.players);
    Result<std::unique_ptr<MatchRecorder>> recorder = open_recorder(options.record, level);
    if (!recorder) {
        return refuse(recorder.error());
    }
    settings.value().recorder = recorder.value().get();
    MatchServer server(scene.value().scene.host, scene.value().players, std::move(settings.value()),
                       *listener.value());
    const std::vector<std::string> urls = listener.value()->urls();
    print_log_line(log_line("serves", {{"url", urls.front()},
                                       {"quic", has_quic() ? urls.back() : "none"},
                                       {"scene", scene.value().scene.name},
                                       {"players", std::to_string(options.players)},
                                       {"tokens", options.token_key.empty() ? "0" : "1"}}));
    serve(options, scene.value().scene, server);
    log_end(scene.value().scene, server);
    return finish_recording(recorder.value().get(), server.match());
}

int token_command(const TokenOptions& options) {
    if (!has_network()) {
        return refuse(open_link(options.key).error());  // says what is missing
    }
    const Result<TokenKey> key = load_token_key(options.key);
    if (!key) {
        return refuse(key.error());
    }
    if (!is_token_name(options.name)) {
        return refuse({options.name, "", "expected a name of 1 to 32 letters, digits, - and _"});
    }
    const auto expires = static_cast<std::int64_t>(std::time(nullptr)) +
                         static_cast<std::int64_t>(60.0 * options.minutes);
    std::printf("%s\n", issue_token(key.value(), options.name, expires).c_str());
    return 0;
}

}  // namespace handhold

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <optional>
#include <sstream>
#include <utility>
#include <vector>

#include "game/commands/match_commands.hpp"
#include "game/levels/built_in_scenes.hpp"
#include "game/net/hmac.hpp"
#include "game/net/match_peer.hpp"
#include "game/net/match_scene.hpp"
#include "game/net/net_log.hpp"
#include "game/net/peer_hands.hpp"
#include "game/play/exit_status.hpp"
#include "game/play/loading.hpp"
#include "game/report/run_summary.hpp"
#include "game/session/interrupt.hpp"

namespace handhold {
namespace {

constexpr double k_offer_within_s = 5.0;
constexpr double k_return_within_s = 60.0;
constexpr double k_return_every_s = 1.0;
constexpr double k_look_s = 0.002;
constexpr double k_leave_within_s = 1.0;
constexpr std::uint64_t k_hash_every_ticks_logged = 450;

double now_s() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

// One player of this process.
struct JoinedPeer {
    MatchScene scene;
    std::unique_ptr<MatchPeer> peer;
    PeerHands hands;
    bool plays = false;
    std::uint64_t logged = 0;      // the last tick whose hash was logged
    std::optional<double> lost_s;  // when the connection was lost
    double next_return_s = 0.0;
    bool is_over = false;
};

Result<Scene> load_match_scene(const JoinOptions& options, const MatchOffer& offer) {
    if (!options.scene.empty()) {
        return load_scene_with_progress(options.scene);
    }
    // A server must not choose which file is opened here.
    const std::vector<std::string_view> names = built_in_scenes();
    if (std::ranges::find(names, offer.scene) == names.end()) {
        return FileError{options.url, "",
                         "the server plays \"" + offer.scene +
                             "\", which is not built in: give its file by --scene"};
    }
    return load_scene_with_progress(offer.scene);
}

// A token for each peer: a line of the file.
Result<std::vector<std::string>> load_tokens(const JoinOptions& options, const MatchOffer& offer) {
    const auto peers = static_cast<std::size_t>(options.peers);
    std::vector<std::string> tokens;
    if (options.token.empty()) {
        if (offer.wants_token) {
            return FileError{options.url, "", refusal_text({NetRefusal::no_token})};
        }
        tokens.resize(peers);
        return tokens;
    }
    const Result<std::string> text = read_file(options.token, peers * (k_most_text_bytes + 1));
    if (!text) {
        return text.error();
    }
    std::istringstream lines(text.value());
    for (std::string line; std::getline(lines, line);) {
        tokens.push_back(line);
    }
    if (tokens.size() < peers) {
        return FileError{options.token, "",
                         "expected " + std::to_string(peers) + " tokens, one a line, found " +
                             std::to_string(tokens.size())};
    }
    return tokens;
}

std::optional<FileError> connect(const JoinOptions& options, JoinedPeer& joined) {
    Result<std::unique_ptr<Link>> link = open_link(options.url);
    if (!link) {
        return link.error();
    }
    joined.peer->connect(std::move(link.value()));
    return std::nullopt;
}

Result<std::unique_ptr<JoinedPeer>> make_peer(const JoinOptions& options, const MatchOffer& offer,
                                              const std::string& token) {
    Result<Scene> scene = load_match_scene(options, offer);
    if (!scene) {
        return scene.error();
    }
    Result<MatchScene> made = make_match_scene(std::move(scene.value()), offer.players, offer.seed);
    if (!made) {
        return made.error();
    }
    auto joined = std::make_unique<JoinedPeer>();
    joined->scene = std::move(made.value());
    if (const auto digest = first_difference(offer.digests, joined->scene.digests)) {
        return FileError{options.url, "",
                         refusal_text({NetRefusal::level, static_cast<std::uint16_t>(*digest)})};
    }
    MatchPeerSettings settings;
    settings.digests = joined->scene.digests;
    settings.person = secret_number();
    settings.token = token;
    settings.tick_s = k_match_tick_s;
    settings.clock = now_s;
    joined->peer = std::make_unique<MatchPeer>(joined->scene.scene.host, joined->scene.players,
                                               std::move(settings));
    return joined;
}

PeerHands choose_hands(const JoinOptions& options, std::size_t number, JoinedPeer& joined,
                       const std::optional<Recording>& recording) {
    if (recording) {
        return RecordedHands(*recording);
    }
    return ClimberHands(joined.scene.scene, joined.scene.players[joined.peer->slot()],
                        options.seed + number);
}

void log_confirmed(JoinedPeer& joined) {
    const hh_match_stats stats = joined.peer->match().stats();
    const std::uint64_t tick =
        stats.confirmed / k_hash_every_ticks_logged * k_hash_every_ticks_logged;
    if (tick > joined.logged && tick + HH_MATCH_PLACES > stats.tick) {
        if (const auto hash = joined.peer->match().hash(tick)) {
            joined.logged = tick;
            print_log_line(log_line("confirmed", {{"slot", std::to_string(joined.peer->slot())},
                                                  {"tick", std::to_string(tick)},
                                                  {"hash", format_hash(*hash)}}));
        }
    }
}

void log_end(const JoinedPeer& joined) {
    if (!joined.peer->match().is_valid()) {
        return;
    }
    const hh_match_stats stats = joined.peer->match().stats();
    print_log_line(log_line(
        "ends", {{"slot", std::to_string(joined.peer->slot())},
                 {"why", joined.peer->why()},
                 {"ticks", std::to_string(stats.ticks)},
                 {"rollbacks", std::to_string(stats.rollbacks)},
                 {"filled", std::to_string(stats.filled)},
                 {"states", std::to_string(joined.peer->states())},
                 {"tick", std::to_string(stats.confirmed)},
                 {"hash", format_hash(joined.peer->match().hash(stats.confirmed).value_or(0))}}));
}

// Connects again while the server may still keep the seat.
void return_to_match(const JoinOptions& options, JoinedPeer& joined) {
    const double at_s = now_s();
    if (!joined.plays || !joined.peer->may_return()) {
        joined.is_over = true;
        return;
    }
    if (!joined.lost_s) {
        joined.lost_s = at_s;
        print_log_line(log_line(
            "lost", {{"slot", std::to_string(joined.peer->slot())}, {"why", joined.peer->why()}}));
    }
    if (at_s - *joined.lost_s > k_return_within_s) {
        joined.is_over = true;
    } else if (at_s >= joined.next_return_s) {
        joined.next_return_s = at_s + k_return_every_s;
        joined.is_over = connect(options, joined).has_value();
    }
}

void run_peer(const JoinOptions& options, std::size_t number, double wait_s,
              const std::optional<Recording>& recording, JoinedPeer& joined) {
    joined.peer->poll(wait_s, [&](double end_s, PeerInput& input) {
        if (joined.hands == nullptr) {
            joined.hands = choose_hands(options, number, joined, recording);
        }
        joined.hands(end_s, input);
    });
    if (joined.peer->stage() == PeerStage::playing) {
        if (!joined.plays || joined.lost_s) {
            print_log_line(log_line(joined.plays ? "returned" : "plays",
                                    {{"slot", std::to_string(joined.peer->slot())}}));
        }
        joined.plays = true;
        joined.lost_s.reset();
        log_confirmed(joined);
    } else if (joined.peer->stage() == PeerStage::ended) {
        return_to_match(options, joined);
    }
}

}  // namespace

int join_command(const JoinOptions& options) {
    const InterruptGuard interrupts;
    const Result<MatchOffer> offer = fetch_offer(options.url, k_offer_within_s);
    if (!offer) {
        return refuse(offer.error());
    }
    const Result<std::vector<std::string>> tokens = load_tokens(options, offer.value());
    if (!tokens) {
        return refuse(tokens.error());
    }
    std::optional<Recording> recording;
    if (!options.input.empty()) {
        Result<Recording> loaded = load_recording(options.input);
        if (!loaded) {
            return refuse(loaded.error());
        }
        recording = std::move(loaded.value());
    }
    std::vector<std::unique_ptr<JoinedPeer>> peers;
    for (int i = 0; i < options.peers; ++i) {
        Result<std::unique_ptr<JoinedPeer>> made =
            make_peer(options, offer.value(), tokens.value()[peers.size()]);
        if (!made) {
            return refuse(made.error());
        }
        peers.push_back(std::move(made.value()));
    }
    for (const auto& joined : peers) {
        if (const auto error = connect(options, *joined)) {
            return refuse(*error);
        }
    }
    const double begin_s = now_s();
    const auto has_time = [&] {
        return options.seconds == 0.0 || now_s() - begin_s < options.seconds;
    };
    const auto is_over = [](const auto& joined) { return joined->is_over; };
    while (!is_interrupted() && has_time() && !std::ranges::all_of(peers, is_over)) {
        for (std::size_t i = 0; i < peers.size(); ++i) {
            if (!peers[i]->is_over) {
                run_peer(options, i, i == 0 ? k_look_s : 0.0, recording, *peers[i]);
            }
        }
    }
    int status = 0;
    for (const auto& joined : peers) {
        const bool has_ended = joined->plays && joined->peer->bye() == NetBye::draining;
        if (joined->is_over && !has_ended && status == 0) {
            status = refuse({options.url, "", joined->peer->why()});
        }
        joined->peer->leave();
        log_end(*joined);
    }
    const double end_s = now_s();
    for (const auto& joined : peers) {
        while (joined->peer->is_linked() && now_s() - end_s < k_leave_within_s) {
            joined->peer->poll(k_look_s, {});
        }
    }
    return status;
}

}  // namespace handhold

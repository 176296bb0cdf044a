#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "game/commands/match_commands.hpp"
#include "game/commands/match_entry.hpp"
#include "game/net/net_log.hpp"
#include "game/net/peer_hands.hpp"
#include "game/play/exit_status.hpp"
#include "game/report/run_summary.hpp"
#include "game/session/interrupt.hpp"

namespace handhold {
namespace {

constexpr double k_join_look_s = 0.002;
constexpr std::uint64_t k_hash_every_ticks_logged = 180;

// One player of this process.
struct JoinedPeer {
    MatchScene scene;
    std::unique_ptr<MatchRecorder> recorder;
    std::unique_ptr<MatchPeer> peer;
    PeerHands hands;
    MatchReturn returns;
    bool was_playing = false;
    std::uint64_t logged = 0;  // the last tick whose hash was logged
    bool is_over = false;
};

// A whole program of peers.
struct JoinedPeers {
    MatchPlace place;
    std::optional<Recording> recording;
    std::uint64_t seed = 1;
    std::vector<std::unique_ptr<JoinedPeer>> peers;
};

std::optional<FileError> add_peer(const JoinOptions& options, const MatchEntry& entry,
                                  JoinedPeers& all) {
    Result<MatchScene> scene = load_entry_scene(all.place, entry.offer);
    if (!scene) {
        return scene.error();
    }
    auto joined = std::make_unique<JoinedPeer>();
    joined->scene = std::move(scene.value());
    Result<std::unique_ptr<MatchRecorder>> recorder = open_recorder(options.record, entry.offer);
    if (!recorder) {
        return recorder.error();
    }
    joined->recorder = std::move(recorder.value());
    MatchPeerSettings settings = make_peer_settings(joined->scene, entry.tokens[all.peers.size()]);
    settings.watches = options.watches;
    settings.recorder = joined->recorder.get();
    joined->peer = std::make_unique<MatchPeer>(joined->scene.scene.host, joined->scene.players,
                                               std::move(settings));
    all.peers.push_back(std::move(joined));
    return std::nullopt;
}

// Loads all that is needed, and begins to connect.
std::optional<FileError> enter(const JoinOptions& options, JoinedPeers& all) {
    all.place = {options.url, options.scene, options.token};
    all.seed = options.seed;
    const auto count = static_cast<std::size_t>(options.peers);
    const Result<MatchEntry> entry = ask_for_entry(all.place, count);
    if (!entry) {
        return entry.error();
    }
    if (!options.input.empty()) {
        Result<Recording> loaded = load_recording(options.input);
        if (!loaded) {
            return loaded.error();
        }
        all.recording = std::move(loaded.value());
    }
    while (all.peers.size() < count) {
        if (auto error = add_peer(options, entry.value(), all)) {
            return error;
        }
    }
    for (const auto& joined : all.peers) {
        if (auto error = connect_peer(all.place, *joined->peer)) {
            return error;
        }
    }
    return std::nullopt;
}

std::string slot_text(const JoinedPeer& joined) {
    const std::size_t slot = joined.peer->slot();
    return slot == MatchWelcome::k_no_slot ? "none" : std::to_string(slot);
}

void log_confirmed(JoinedPeer& joined) {
    const hh_match_stats stats = joined.peer->match().stats();
    const std::uint64_t tick =
        stats.confirmed / k_hash_every_ticks_logged * k_hash_every_ticks_logged;
    if (tick > joined.logged && tick + HH_MATCH_PLACES > stats.tick) {
        if (const auto hash = joined.peer->match().hash(tick)) {
            joined.logged = tick;
            print_log_line(log_line("confirmed", {{"slot", slot_text(joined)},
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
        "ends", {{"slot", slot_text(joined)},
                 {"why", joined.peer->why()},
                 {"ticks", std::to_string(stats.ticks)},
                 {"rollbacks", std::to_string(stats.rollbacks)},
                 {"filled", std::to_string(stats.filled)},
                 {"states", std::to_string(joined.peer->states())},
                 {"tick", std::to_string(stats.confirmed)},
                 {"hash", format_hash(joined.peer->match().hash(stats.confirmed).value_or(0))}}));
}

void log_change(JoinedPeer& joined) {
    const bool plays = joined.peer->stage() == PeerStage::playing;
    if (plays == joined.was_playing) {
        return;
    }
    joined.was_playing = plays;
    print_log_line(log_line(!plays                   ? "waits"
                            : joined.peer->watches() ? "watches"
                                                     : "plays",
                            {{"slot", slot_text(joined)},
                             {"states", std::to_string(joined.peer->states())},
                             {"why", plays ? "joined" : joined.peer->why()}}));
}

void run_peer(JoinedPeers& all, std::size_t number, double wait_s) {
    JoinedPeer& joined = *all.peers[number];
    joined.peer->poll(wait_s, [&](double end_s, PeerInput& input) {
        if (joined.hands == nullptr && all.recording) {
            joined.hands = RecordedHands(*all.recording);
        } else if (joined.hands == nullptr) {
            joined.hands = ClimberHands(
                joined.scene.scene, joined.scene.players[joined.peer->slot()], all.seed + number);
        }
        joined.hands(end_s, input);
    });
    log_change(joined);
    if (joined.was_playing) {
        log_confirmed(joined);
    }
    joined.is_over = !joined.returns.goes_on(all.place, *joined.peer);
}

}  // namespace

int join_command(const JoinOptions& options) {
    const InterruptGuard interrupts;
    JoinedPeers all;
    if (const auto error = enter(options, all)) {
        return refuse(*error);
    }
    const double begin_s = match_now_s();
    const auto has_time = [&] {
        return options.seconds == 0.0 || match_now_s() - begin_s < options.seconds;
    };
    const auto is_over = [](const auto& joined) { return joined->is_over; };
    while (!is_interrupted() && has_time() && !std::ranges::all_of(all.peers, is_over)) {
        double wait_s = k_join_look_s;  // one peer waits for all
        for (std::size_t i = 0; i < all.peers.size(); ++i) {
            if (!all.peers[i]->is_over) {
                run_peer(all, i, std::exchange(wait_s, 0.0));
            }
        }
    }
    int status = 0;
    for (const auto& joined : all.peers) {
        const bool has_ended =
            joined->returns.has_played() && joined->peer->bye() == NetBye::draining;
        if (joined->is_over && !has_ended && status == 0) {
            status = refuse({options.url, "", joined->peer->why()});
        }
        log_end(*joined);
        const int recorded = finish_recording(joined->recorder.get(), joined->peer->match());
        status = status == 0 ? recorded : status;
        leave_match(*joined->peer);
    }
    return status;
}

}  // namespace handhold

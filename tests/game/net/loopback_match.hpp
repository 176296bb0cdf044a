#pragma once

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "game/net/match_peer.hpp"
#include "game/net/match_scene.hpp"
#include "game/net/match_server.hpp"
#include "game/net/peer_hands.hpp"
#include "tests/game/climber/climber_scene.hpp"

// A server and its peers in one thread, over real sockets of the loopback interface.
namespace handhold::test {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define HH_SLOW_BUILD 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define HH_SLOW_BUILD 1
#endif
#endif

// Tests with bounds of the wall's clock fail on a machine that is busy with something else: they
// run where HANDHOLD_REALTIME_TESTS is set, as by .ci/long.
inline bool has_time_to_itself() { return std::getenv("HANDHOLD_REALTIME_TESTS") != nullptr; }
#define HH_NEEDS_REAL_TIME()                                                       \
    if (!test::has_time_to_itself()) {                                             \
        GTEST_SKIP() << "bounds of the wall's clock: set HANDHOLD_REALTIME_TESTS"; \
    }

// The match's clock runs faster than the wall's, so that tests take less time. With sanitizers four
// worlds need more time than a tick has.
#ifdef HH_SLOW_BUILD
inline constexpr double k_clock_rate = 0.2;
#else
inline constexpr double k_clock_rate = 2.0;
#endif

inline double match_clock_s() {
    return k_clock_rate *
           std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
               .count();
}

inline Scene tunnel_with_loose_boxes() {
    Scene scene = make_tunnel(5.0);
    scene.spawns.push_back({"middle", hh::pose_at({0.0, -1.6, 0.0})});
    for (int i = 0; i < 8; ++i) {
        hh_body_def box = hh::body_def();
        box.kind = HH_DYNAMIC;
        box.mass_kg = 2.0;
        box.shape = *scene.host.add_box({0.1, 0.1, 0.1});
        box.pose.position = {0.5, -0.6, -3.5 + i};
        (void)scene.host.add(box);
    }
    add_grip_meshes(scene);
    return scene;
}

inline MatchScene tunnel_match(std::size_t players) {
    return std::move(make_match_scene(tunnel_with_loose_boxes(), players, 7).value());
}

using MakeMatch = std::function<MatchScene(std::size_t players)>;

// One player with a world of its own. Compares each confirmed tick with the server's.
struct LoopbackPeer {
    explicit LoopbackPeer(std::size_t players, std::uint64_t number, std::string token = {},
                          const MakeMatch& make = tunnel_match)
        : scene(make(players)), seed(number) {
        settings.digests = scene.digests;
        settings.arena = scene.scene.arena ? &*scene.scene.arena : nullptr;
        settings.person = number;
        settings.token = std::move(token);
        settings.clock = match_clock_s;
    }
    void connect(std::unique_ptr<Link> link) {
        if (peer == nullptr) {
            peer = std::make_unique<MatchPeer>(scene.scene.host, scene.players, settings);
        }
        peer->connect(std::move(link));
    }
    void poll() {
        peer->poll(0.0, [this](double end_s, PeerInput& input) {
            if (hands == nullptr) {
                hands = ClimberHands(scene.scene, scene.players[peer->slot()], seed);
            }
            hands(end_s, input);
        });
    }
    bool plays() const { return peer->stage() == PeerStage::playing; }

    MatchScene scene;
    std::uint64_t seed;
    MatchPeerSettings settings;
    std::unique_ptr<MatchPeer> peer;
    PeerHands hands;
    std::uint64_t compared_until = 0;
    std::uint64_t compared = 0;
    std::uint64_t different = 0;
};

class LoopbackMatch {
  public:
    explicit LoopbackMatch(std::size_t players,
                           const std::function<void(MatchServerSettings&)>& change = {},
                           const std::function<void(ListenerSettings&)>& change_listener = {},
                           MakeMatch make = tunnel_match)
        : make_(std::move(make)), scene_(make_(players)) {
        ListenerSettings listening;
        // QUIC's handshake and its repeats follow the wall's clock.
        listening.budget.messages_per_s *= std::max(1.0, k_clock_rate);
        listening.budget.bytes_per_s *= std::max(1.0, k_clock_rate);
        if (change_listener) {
            change_listener(listening);
        }
        listener_ = std::move(open_listener(listening).value());
        MatchServerSettings settings;
        settings.offer.scene = scene_.scene.name;
        settings.offer.digests = scene_.digests;
        settings.arena = scene_.scene.arena ? &*scene_.scene.arena : nullptr;
        settings.clock = match_clock_s;
        settings.today = [] { return std::int64_t{1000}; };
        settings.longest_wait_s = 0.001;
        settings.log = [this](const std::string& line) { log.push_back(line); };
        if (change) {
            change(settings);
        }
        server = std::make_unique<MatchServer>(scene_.scene.host, scene_.players,
                                               std::move(settings), *listener_);
    }

    // A world in a match is not destroyed, so the match goes first.
    ~LoopbackMatch() { server.reset(); }
    LoopbackMatch(const LoopbackMatch&) = delete;
    LoopbackMatch& operator=(const LoopbackMatch&) = delete;

    // The first one: WebSocket's, where there is one.
    std::string url() const { return listener_->urls().front(); }
    std::string quic_url() const { return listener_->urls().back(); }
    std::unique_ptr<Link> link() const { return std::move(open_link(url()).value()); }
    const Listener& listener() const { return *listener_; }
    MatchScene& scene() { return scene_; }
    LoopbackPeer& add_peer(std::uint64_t number, std::string token = {}) {
        peers.push_back(
            std::make_unique<LoopbackPeer>(scene_.players.size(), number, std::move(token), make_));
        peers.back()->connect(link());
        return *peers.back();
    }

    // Runs everybody until the condition holds. False: it did not within so much of the match's
    // time.
    bool run_until(double within_s, const std::function<bool()>& is_reached) {
        const double until_s = match_clock_s() + within_s;
        while (!is_reached()) {
            if (match_clock_s() > until_s) {
                return false;
            }
            step();
        }
        return true;
    }
    void run(double seconds) {
        const double until_s = match_clock_s() + seconds;
        run_until(seconds + 1.0, [&] { return match_clock_s() >= until_s; });
    }
    // Of the server's ticks that were the last ones of a poll.
    const std::map<std::uint64_t, std::uint64_t>& hashes() const { return hashes_; }
    bool all_play() {
        return std::ranges::all_of(peers, [](const auto& peer) { return peer->plays(); });
    }

    std::unique_ptr<MatchServer> server;
    std::vector<std::unique_ptr<LoopbackPeer>> peers;
    std::vector<std::string> log;
    std::uint64_t grips = 0;       // hands that closed on something, in the server's world
    std::function<void()> others;  // called in each round
    double longest_poll_s = 0.0;   // of the server, wall time

  private:
    void step() {
        const double begin_s = match_clock_s();
        server->poll();
        longest_poll_s = std::max(longest_poll_s, (match_clock_s() - begin_s) / k_clock_rate);
        const std::uint64_t tick = server->match().stats().tick;
        if (tick > last_tick_) {
            last_tick_ = tick;
            hashes_[tick] = *server->match().hash(tick);
            for (const hh_match_event& event : server->match().events()) {
                grips += event.event.kind == HH_EVENT_GRABBED ? 1U : 0U;
            }
        }
        for (const auto& peer : peers) {
            peer->poll();
            compare(*peer);
        }
        if (others) {
            others();
        }
    }
    // Ticks that the server confirmed together with later ones are left out.
    void compare(LoopbackPeer& peer) {
        if (!peer.plays()) {
            return;
        }
        const hh_match_stats stats = peer.peer->match().stats();
        for (std::uint64_t tick = peer.compared_until + 1; tick <= stats.confirmed; ++tick) {
            const auto known = hashes_.find(tick);
            if (tick + HH_MATCH_PLACES <= stats.tick || known == hashes_.end()) {
                continue;
            }
            const auto hash = peer.peer->match().hash(tick);
            if (!hash) {
                continue;  // before the state that it joined with
            }
            ++peer.compared;
            peer.different += *hash != known->second ? 1U : 0U;
        }
        peer.compared_until = std::max(peer.compared_until, stats.confirmed);
    }

    MakeMatch make_;
    MatchScene scene_;
    std::unique_ptr<Listener> listener_;
    std::map<std::uint64_t, std::uint64_t> hashes_;
    std::uint64_t last_tick_ = 0;
};

}  // namespace handhold::test

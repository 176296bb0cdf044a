#include "tools/lab/match_run.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <vector>

#include "engine/core/profile.hpp"
#include "systems/match/client_session.hpp"
#include "systems/match/server_session.hpp"
#include "tools/lab/holds_count.hpp"
#include "tools/lab/match_scene.hpp"

namespace handhold::lab {
namespace {

constexpr double k_match_tick_s = 1.0 / 90.0;
constexpr double k_warm_s = 2.0;
constexpr double k_look_s = 1.0 / 360.0;  // how often the server looks at its packets
constexpr double k_device_s = 1.0 / 97.0;
constexpr std::size_t k_kept = ClientSession::k_window;

double us_since(std::int64_t begin_ns) {
    return 1e-3 * static_cast<double>(stage_now_ns() - begin_ns);
}

// Positions of all players' tracked hands, in the world.
using HandsOfAll = std::array<std::array<Vec3, k_hand_count>, k_most_match_players>;
void note_hands(const MatchWorld& match, HandsOfAll& out) {
    const World& world = match.world;
    for (std::size_t i = 0; i < world.hand_owner.size(); ++i) {
        const HandOwner& owner = world.hand_owner.elements()[i];
        const Entity hand = world.hand_owner.owners()[i];
        for (std::size_t slot = 0; slot < match.player_count; ++slot) {
            if (find_by_id(world, match.players[slot]) == owner.player) {
                const Pose hand_ws = world.player_origin.at(owner.player).pose_ws *
                                     world.hand_tracking.at(hand).pose_ps;
                out[slot][index_of(owner.side)] = hand_ws.position;
            }
        }
    }
}

struct Peer {
    std::unique_ptr<MatchScene> scene;
    std::unique_ptr<ClientSession> session;
    TickSampler devices;
    double next_sample_s = 0.0;
    double phase_s = 0.0;  // phase of the frames
    MatchTick compared_until = 0;
    std::uint64_t frames = 0;
    double up_bytes = 0.0;  // bytes of this second
    double down_bytes = 0.0;
    InputsBefore before = {&k_away_input, &k_away_input, &k_away_input};
    std::array<MatchInput, 4> inputs;  // the last ones
    std::array<HandsOfAll, k_kept> first_shown;
};

class MatchRun {
  public:
    explicit MatchRun(const MatchRunOptions& options)
        : options_(options),
          network_(options.network, options.seed),
          scene_(options.scene, static_cast<std::size_t>(options.peers)),
          server_(std::make_unique<ServerSession>(scene_.match(k_match_tick_s), 0.0)) {
        for (std::size_t i = 0; i < peer_count(); ++i) {
            peers_.push_back(std::make_unique<Peer>());
            Peer& peer = *peers_.back();
            peer.scene = std::make_unique<MatchScene>(options.scene, peer_count());
            peer.session = std::make_unique<ClientSession>(peer.scene->match(k_match_tick_s), i);
            peer.phase_s =
                k_match_tick_s * static_cast<double>(i) / static_cast<double>(peer_count());
            server_->connect(i);
        }
        server_hashes_.push_back(hash_simulated(scene_.world()));
        server_hands_.emplace_back();
    }

    MatchFigures run() {
        const auto looks = static_cast<std::uint64_t>(options_.seconds / k_look_s);
        for (std::uint64_t look = 1; look <= looks; ++look) {
            now_s_ = k_look_s * static_cast<double>(look);
            deliver();
            step_server(look);
            for (std::size_t i = 0; i < peer_count(); ++i) {
                step_peer(i);
            }
            if (look % 360 == 0) {
                end_second();
            }
        }
        for (const auto& peer : peers_) {
            figures_.ticks += peer->session->counts().ticks;
            figures_.stalls += peer->session->counts().waits;
        }
        figures_.confirmed_ticks = server_->counts().ticks;
        figures_.grips = holds_.grips;
        figures_.shared_holds = holds_.shared_holds;
        return std::move(figures_);
    }

  private:
    std::size_t peer_count() const { return static_cast<std::size_t>(options_.peers); }
    std::size_t place_of_server() const { return peer_count(); }
    bool is_warm() const { return now_s_ > k_warm_s; }
    bool sends(std::uint64_t frame) const {
        return options_.packets_per_tick >= 1.0 || frame % 2 == 0;
    }

    void deliver() {
        network_.deliver(now_s_,
                         [&](std::size_t from, std::size_t to, std::span<const std::byte> bytes) {
                             const std::int64_t begin_ns = stage_now_ns();
                             if (to == place_of_server()) {
                                 server_->receive(from, bytes, now_s_);
                                 server_us_ += us_since(begin_ns);
                             } else {
                                 peers_[to]->session->receive(bytes);
                             }
                         });
    }

    void step_server(std::uint64_t look) {
        for (;;) {
            const MatchTick before = server_->confirmed();
            const std::uint64_t filled = server_->counts().filled;
            const std::int64_t begin_ns = stage_now_ns();
            server_->advance(now_s_, 1);
            server_us_ += us_since(begin_ns);
            if (server_->confirmed() == before) {
                break;
            }
            server_hashes_.push_back(hash_simulated(scene_.world()));
            server_hands_.emplace_back();
            note_hands(scene_.match(k_match_tick_s), server_hands_.back());
            holds_.add(scene_.world());
            if (is_warm()) {
                figures_.server_tick_us.add(server_us_);
                figures_.filled += server_->counts().filled - filled;
                figures_.asked += peer_count();
            }
            server_us_ = 0.0;
        }
        if (look % 4 != 0 || !sends(look / 4)) {
            return;
        }
        std::array<std::byte, k_most_packet_bytes> packet{};
        for (std::size_t i = 0; i < peer_count(); ++i) {
            const std::int64_t begin_ns = stage_now_ns();
            const std::size_t size = server_->write_packet(i, packet);
            server_us_ += us_since(begin_ns);
            peers_[i]->down_bytes += static_cast<double>(size) + options_.network.overhead_bytes;
            figures_.largest_packet = std::max<std::uint64_t>(figures_.largest_packet, size);
            network_.send(place_of_server(), i, std::span(packet).first(size), now_s_);
        }
    }

    MatchInput own_input(std::size_t i) {
        Peer& peer = *peers_[i];
        const double start_s = static_cast<double>(peer.session->now()) * k_match_tick_s;
        for (; peer.next_sample_s <= start_s + k_match_tick_s; peer.next_sample_s += k_device_s) {
            peer.devices.add(devices_at(options_.scene, i, peer.next_sample_s));
        }
        return normalised(peer.devices.take(start_s, start_s + k_match_tick_s, {}));
    }

    void step_peer(std::size_t i) {
        Peer& peer = *peers_[i];
        peer.phase_s += k_look_s;
        if (peer.phase_s < k_match_tick_s) {
            return;
        }
        peer.phase_s -= k_match_tick_s;
        const int ticks = peer.session->ticks_due(k_match_tick_s);
        for (int tick = 0; tick < ticks; ++tick) {
            advance(i, tick + 1 == ticks);
        }
        compare(i);
        if (sends(++peer.frames)) {
            std::array<std::byte, k_most_packet_bytes> packet{};
            const std::size_t size = peer.session->write_packet(packet);
            peer.up_bytes += static_cast<double>(size) + options_.network.overhead_bytes;
            network_.send(i, place_of_server(), std::span(packet).first(size), now_s_);
        }
    }

    void advance(std::size_t i, bool is_shown) {
        Peer& peer = *peers_[i];
        const MatchTick tick = peer.session->now() + 1;
        const MatchInput own = own_input(i);
        const std::uint64_t again = peer.session->counts().steps_again;
        const std::int64_t begin_ns = stage_now_ns();
        if (!peer.session->advance(own, is_shown)) {
            return;
        }
        const double us = us_since(begin_ns);
        if (is_warm()) {
            const std::uint64_t depth = peer.session->counts().steps_again - again;
            figures_.client_tick_us.add(us);
            if (depth > 0) {
                figures_.rollback_ticks.add(static_cast<double>(depth));
                figures_.rollback_us.add(us);
            }
            measure_input(peer, own);
        }
        note_hands(peer.scene->match(k_match_tick_s), peer.first_shown[tick % k_kept]);
    }

    void measure_input(Peer& peer, const MatchInput& own) {
        std::array<std::byte, 512> bytes{};
        BitWriter out(bytes);
        write_input(peer.before, own, out);
        figures_.input_bytes.add(static_cast<double>(out.bits()) / 8.0);
        auto& inputs = peer.inputs;
        std::rotate(inputs.begin(), inputs.end() - 1, inputs.end());
        inputs.front() = own;
        peer.before = {inputs.data(), &inputs[1], &inputs[2]};
    }

    // Compares final ticks with the server's world, and what was first guessed of others.
    void compare(std::size_t i) {
        Peer& peer = *peers_[i];
        const ClientSession& session = *peer.session;
        const MatchTick until = session.final_state();
        for (MatchTick tick = peer.compared_until + 1; tick <= until; ++tick) {
            if (tick + k_kept <= session.now() || tick >= server_hashes_.size()) {
                continue;
            }
            ++figures_.hashes_compared;
            figures_.hashes_different += session.hash_at(tick) != server_hashes_[tick] ? 1U : 0U;
            for (std::size_t slot = 0; slot < peer_count() && is_warm(); ++slot) {
                for (std::size_t side = 0; side < k_hand_count && slot != i; ++side) {
                    const Vec3& shown = peer.first_shown[tick % k_kept][slot][side];
                    figures_.others_hand_m.add((shown - server_hands_[tick][slot][side]).norm());
                }
            }
        }
        peer.compared_until = std::max(peer.compared_until, until);
    }

    void end_second() {
        for (const auto& peer : peers_) {
            if (is_warm()) {
                figures_.up_kbps.add(8e-3 * peer->up_bytes);
                figures_.down_kbps.add(8e-3 * peer->down_bytes);
            }
            peer->up_bytes = peer->down_bytes = 0.0;
        }
    }

    MatchRunOptions options_;
    SimulatedNetwork network_;
    MatchScene scene_;
    std::unique_ptr<ServerSession> server_;
    std::vector<std::unique_ptr<Peer>> peers_;
    std::vector<std::uint64_t> server_hashes_;
    std::vector<HandsOfAll> server_hands_;
    double now_s_ = 0.0;
    double server_us_ = 0.0;  // since the last confirmed tick
    HoldsCount holds_;
    MatchFigures figures_;
};

}  // namespace

MatchFigures run_match(const MatchRunOptions& options) {
    const auto run = std::make_unique<MatchRun>(options);
    return run->run();
}

}  // namespace handhold::lab

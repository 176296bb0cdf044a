#include "tools/lab/match_run.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <vector>

#include "engine/core/parallel.hpp"
#include "engine/core/profile.hpp"
#include "systems/match/client_session.hpp"
#include "systems/match/server_session.hpp"
#include "tools/lab/match_scene.hpp"

namespace handhold::lab {
namespace {

constexpr double k_match_tick_s = 1.0 / 90.0;
constexpr double k_warm_s = 2.0;
constexpr double k_look_s = 1.0 / 360.0;  // how often the server looks at its packets
constexpr std::size_t k_kept = ClientSession::k_window;

// Clock of calls that may run on several threads.
std::int64_t call_now_ns() { return thread_count() == 1 ? thread_cpu_now_ns() : now_ns(); }

double us_since(std::int64_t begin_ns) {
    return 1e-3 * static_cast<double>(call_now_ns() - begin_ns);
}

PointsOfAll moved_by(const PointsOfAll& points, const PointsOfAll& offsets) {
    PointsOfAll out = points;
    for (std::size_t slot = 0; slot < out.size(); ++slot) {
        out[slot].head += offsets[slot].head;
        for (std::size_t side = 0; side < k_hand_count; ++side) {
            out[slot].hands[side] += offsets[slot].hands[side];
        }
    }
    return out;
}

// True if a hand of this player and one of another hold the same free body.
bool shares_a_body(const MatchWorld& match, std::size_t slot) {
    const World& world = match.world;
    const Entity player = find_by_id(world, match.players[slot]);
    for (std::size_t a = 0; a < world.grab.size(); ++a) {
        const Grab& own = world.grab.elements()[a];
        if (own.kind != GripKind::held ||
            world.hand_owner.at(world.grab.owners()[a]).player != player) {
            continue;
        }
        for (std::size_t b = 0; b < world.grab.size(); ++b) {
            const Grab& other = world.grab.elements()[b];
            if (other.kind == GripKind::held && other.body == own.body &&
                world.hand_owner.at(world.grab.owners()[b]).player != player) {
                return true;
            }
        }
    }
    return false;
}

struct Peer {
    std::unique_ptr<MatchScene> scene;
    std::unique_ptr<ClientSession> session;
    std::unique_ptr<MatchHands> hands;
    TickSampler devices;
    double sampled_until_s = -1.0;
    double phase_s = 0.0;  // phase of the frames
    MatchTick compared_until = 0;
    std::uint64_t frames = 0;
    double up_bytes = 0.0;  // bytes of this second
    double down_bytes = 0.0;
    InputsBefore before = {&k_away_input, &k_away_input, &k_away_input};
    std::array<MatchInput, 4> inputs;  // the last ones
    std::array<PointsOfAll, k_kept> first_stepped;
    std::array<PointsOfAll, k_kept> first_shown;  // drawn positions
};

class MatchRun {
  public:
    explicit MatchRun(const MatchRunOptions& options)
        : options_(options),
          network_(options.network, options.seed),
          scene_(options.setting),
          server_(std::make_unique<ServerSession>(scene_.match(k_match_tick_s), 0.0)) {
        for (std::size_t i = 0; i < peer_count(); ++i) {
            peers_.push_back(std::make_unique<Peer>());
            Peer& peer = *peers_.back();
            peer.scene = std::make_unique<MatchScene>(options.setting);
            peer.hands = std::make_unique<MatchHands>(options.setting, i);
            peer.session = std::make_unique<ClientSession>(peer.scene->match(k_match_tick_s), i);
            peer.phase_s =
                k_match_tick_s * static_cast<double>(i) / static_cast<double>(peer_count());
            server_->connect(i);
        }
        server_hashes_.push_back(hash_simulated(scene_.world()));
        note_server();
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
        return std::move(figures_);
    }

  private:
    std::size_t peer_count() const { return options_.setting.players; }
    std::size_t place_of_server() const { return peer_count(); }
    bool is_warm() const { return now_s_ > k_warm_s; }
    bool sends(std::uint64_t frame) const {
        return options_.packets_per_tick >= 1.0 || frame % 2 == 0;
    }

    void deliver() {
        network_.deliver(now_s_,
                         [&](std::size_t from, std::size_t to, std::span<const std::byte> bytes) {
                             const std::int64_t begin_ns = call_now_ns();
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
            const std::int64_t begin_ns = call_now_ns();
            server_->advance(now_s_, 1);
            server_us_ += us_since(begin_ns);
            if (server_->confirmed() == before) {
                break;
            }
            server_hashes_.push_back(hash_simulated(scene_.world()));
            note_server();
            figures_.holds.add(scene_.world());
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
            const std::int64_t begin_ns = call_now_ns();
            const std::size_t size = server_->write_packet(i, packet);
            server_us_ += us_since(begin_ns);
            peers_[i]->down_bytes += static_cast<double>(size) + options_.network.overhead_bytes;
            figures_.largest_packet = std::max<std::uint64_t>(figures_.largest_packet, size);
            network_.send(place_of_server(), i, std::span(packet).first(size), now_s_);
        }
    }

    void note_server() {
        const MatchWorld match = scene_.match(k_match_tick_s);
        note_points(match, server_points_.emplace_back());
        auto& shares = server_shares_.emplace_back();
        for (std::size_t i = 0; i < peer_count(); ++i) {
            shares[i] = shares_a_body(match, i);
        }
    }

    // Devices say where they are at the tick's end, as headsets do: the sample after it is known.
    MatchInput own_input(std::size_t i) {
        Peer& peer = *peers_[i];
        const double start_s = static_cast<double>(peer.session->now()) * k_match_tick_s;
        while (peer.sampled_until_s <= start_s + k_match_tick_s) {
            const TrackingSample sample = peer.hands->next();
            peer.devices.add(sample);
            peer.sampled_until_s = sample.t_s;
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
        const std::int64_t begin_ns = call_now_ns();
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
            measure_ages(i);
        }
        PointsOfAll& stepped = peer.first_stepped[tick % k_kept];
        note_points(peer.scene->match(k_match_tick_s), stepped);
        peer.first_shown[tick % k_kept] = moved_by(stepped, peer.session->shown_offsets());
    }

    void measure_ages(std::size_t i) {
        const ClientSession& session = *peers_[i]->session;
        for (std::size_t slot = 0; slot < peer_count(); ++slot) {
            const MatchTick newest = session.inputs_of(slot).last_real();
            if (slot != i && newest > 0 && newest < session.now()) {
                figures_.others_age_s.add(k_match_tick_s *
                                          static_cast<double>(session.now() - newest));
            }
        }
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
            if (is_warm()) {
                compare_shown(i, tick);
            }
        }
        peer.compared_until = std::max(peer.compared_until, until);
    }

    void compare_shown(std::size_t i, MatchTick tick) {
        const Peer& peer = *peers_[i];
        const PointsOfAll& truth = server_points_[tick];
        const PointsOfAll& truth_before = server_points_[tick - 1];
        const auto now = [tick](const auto& kept) -> const PointsOfAll& {
            return kept[tick % k_kept];
        };
        const auto before = [tick](const auto& kept) -> const PointsOfAll& {
            return kept[(tick - 1) % k_kept];
        };
        const auto view_beyond_m = [&](const auto& kept) {
            return (now(kept)[i].head - before(kept)[i].head - truth[i].head + truth_before[i].head)
                .norm();
        };
        const bool shares = server_shares_[tick][i];
        (shares ? figures_.own_view_shared_raw_m : figures_.own_view_raw_m)
            .add(view_beyond_m(peer.first_stepped));
        (shares ? figures_.own_view_shared_m : figures_.own_view_m)
            .add(view_beyond_m(peer.first_shown));
        for (std::size_t slot = 0; slot < peer_count(); ++slot) {
            for (std::size_t side = 0; side < k_hand_count && slot != i; ++side) {
                const Vec3& true_m = truth[slot].hands[side];
                const Vec3 true_step_m = true_m - truth_before[slot].hands[side];
                const auto jump_m = [&](const auto& kept) {
                    return (now(kept)[slot].hands[side] - before(kept)[slot].hands[side] -
                            true_step_m)
                        .norm();
                };
                figures_.others_hand_m.add(
                    (now(peer.first_stepped)[slot].hands[side] - true_m).norm());
                figures_.others_shown_m.add(
                    (now(peer.first_shown)[slot].hands[side] - true_m).norm());
                figures_.others_jump_raw_m.add(jump_m(peer.first_stepped));
                figures_.others_jump_m.add(jump_m(peer.first_shown));
            }
        }
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
    std::vector<PointsOfAll> server_points_;
    std::vector<std::array<bool, k_most_match_players>> server_shares_;
    double now_s_ = 0.0;
    double server_us_ = 0.0;  // since the last confirmed tick
    MatchFigures figures_;
};

}  // namespace

MatchFigures run_match(const MatchRunOptions& options) {
    const auto run = std::make_unique<MatchRun>(options);
    return run->run();
}

}  // namespace handhold::lab

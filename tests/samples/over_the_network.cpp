// The guide's match: a server and two players, each with a world of its own, over a queue that
// loses packets. Their worlds and their scores are equal, bit for bit.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <deque>
#include <memory>
#include <span>
#include <vector>

#include <handhold/match.hpp>
#include <handhold/math.hpp>

namespace {

constexpr double k_tick_s = 1.0 / 90.0;
constexpr std::uint32_t k_seats = 2;
constexpr std::uint32_t k_to_server = k_seats;

// A network: every packet takes five ticks, and one of twelve is lost.
struct Packet {
    int arrives = 0;  // in this frame
    std::uint32_t from = 0;
    std::uint32_t to = 0;
    std::vector<std::byte> bytes;
};
struct Queue {
    std::deque<Packet> packets;
    int sent = 0;

    void send(std::uint32_t from, std::uint32_t to, int frame, std::vector<std::byte> bytes) {
        if (++sent % 12 != 0) {
            packets.push_back({frame + 5, from, to, std::move(bytes)});
        }
    }
};

// [game]
// Your own state of the match. It is copied when the match goes back, so it has no pointers.
struct Score {
    std::uint64_t grips = 0;
    std::uint64_t presses = 0;

    std::uint64_t hash() const { return 31 * grips + presses; }
};

// The same on every machine: level, players, names, tuning and rules.
struct Machine {
    hh::World world;
    std::array<hh::Player, k_seats> players{};
    hh::MatchGame<Score> game{
        [this](Score& score, std::uint64_t /*tick*/, std::span<const std::uint32_t> buttons) {
            for (const hh::Event& event : world.events()) {
                score.grips += event.kind == HH_EVENT_GRABBED ? 1 : 0;
            }
            for (const std::uint32_t pressed : buttons) {
                score.presses += pressed != 0 ? 1 : 0;
            }
        }};
    hh_match_game callbacks = game.callbacks();
    hh::Match match;

    Machine(hh_match_role role, std::uint32_t slot) {
        hh_body_def wall = hh::body_def();
        wall.shape = *world.add_box({4.0, 2.0, 0.1});
        wall.pose.position = {0.0, 1.5, -0.6};
        (void)world.add(wall);
        for (std::uint32_t seat = 0; seat < k_seats; ++seat) {
            hh_player_def player = hh::player_def();
            player.origin.position.x = 1.5 * seat;
            players[seat] = *world.add(player);
            (void)world.use_wrists(players[seat]);
        }
        hh_match_def def = hh::match_def();
        def.role = role;
        def.slot = slot;
        match = hh::Match(world, players, def, &callbacks);
    }
};
// [game]

// What a headset would say: hands that wave before the wall and close now and then.
hh::Sample devices(std::uint32_t seat, double t) {
    hh::Sample sample = hh::sample();
    sample.time_s = t;
    sample.head.position.y = 1.6;
    const hh::Quat palm_ahead{0.7071067811865476, 0.0, 0.0, 0.7071067811865476};
    for (std::size_t side = 0; side < 2; ++side) {
        const double x = side == 0 ? -0.2 : 0.2;
        sample.hands[side] =
            hh::pose_at({x + 0.05 * std::sin(2.0 * t + seat), 1.4, -0.43}, palm_ahead);
        sample.grab[side] = std::fmod(t + 0.3 * seat + 0.5 * x, 1.1) > 0.5;
    }
    return sample;
}

}  // namespace

int main() {
    Machine server(HH_MATCH_SERVER, 0);
    std::array<std::unique_ptr<Machine>, k_seats> clients;
    for (std::uint32_t seat = 0; seat < k_seats; ++seat) {
        clients[seat] = std::make_unique<Machine>(HH_MATCH_CLIENT, seat);
        if (!server.match.connect(seat)) {
            return 1;
        }
    }
    Queue queue;
    std::vector<std::uint64_t> server_hashes(1, *server.match.hash(0));
    std::uint64_t compared = 0;
    std::uint64_t checked_until = 0;
    int sounds = 0;
    int feed = 0;
    double farthest_m = 0.0;  // of the drawn players
    for (int frame = 1; frame <= 360; ++frame) {
        const double now_s = frame * k_tick_s;
        while (!queue.packets.empty() && queue.packets.front().arrives <= frame) {
            const Packet& packet = queue.packets.front();
            const hh::Status status =
                packet.to == k_to_server
                    ? server.match.receive_from(packet.from, now_s, packet.bytes)
                    : clients[packet.to]->match.receive(packet.bytes);
            if (!status) {
                return 1;
            }
            queue.packets.pop_front();
        }
        // [server]
        std::vector<std::byte> packet;
        (void)server.match.confirm(now_s);
        for (std::uint32_t seat = 0; seat < k_seats; ++seat) {
            (void)server.match.packet_to(seat, packet);
            queue.send(k_to_server, seat, frame, packet);
        }
        // [server]
        server_hashes.resize(server.match.stats().tick + 1);
        server_hashes.back() = *server.match.hash(server.match.stats().tick);
        for (std::uint32_t seat = 0; seat < k_seats; ++seat) {
            Machine& own = *clients[seat];
            // [client]
            const std::uint32_t ticks = *own.match.ticks_due(k_tick_s);
            for (std::uint32_t i = 0; i < ticks; ++i) {
                const double end_s = own.world.time_s() + k_tick_s;
                const hh::Sample sample = devices(seat, end_s);
                hh_match_input input = hh::match_input({&sample, 1}, frame % 50 == 0 ? 1 : 0);
                input.is_hidden = i + 1 < ticks;
                (void)own.match.advance(input);
                for (const hh_match_event& event : own.match.events()) {
                    const bool is_grip = event.event.kind == HH_EVENT_GRABBED;
                    sounds += is_grip && event.state == HH_MATCH_PREDICTED ? 1 : 0;  // at once
                    feed += is_grip && event.state == HH_MATCH_CONFIRMED ? 1 : 0;    // for certain
                }
            }
            (void)own.match.packet(packet);
            queue.send(seat, k_to_server, frame, packet);
            // [client]
            // [draw]
            const hh::Sample newest = devices(seat, own.world.time_s());
            for (std::uint32_t slot = 0; slot < k_seats; ++slot) {
                if (const auto drawn =
                        own.match.drawn_player(slot, slot == seat ? &newest : nullptr)) {
                    farthest_m = std::max(farthest_m, hh::length(drawn->origin.position));
                }
            }
            // [draw]
        }
        // Every confirmed tick of the first client is the server's.
        const hh_match_stats stats = clients[0]->match.stats();
        for (std::uint64_t tick = checked_until + 1; tick <= stats.confirmed; ++tick) {
            if (tick + HH_MATCH_PLACES <= stats.tick || server_hashes.at(tick) == 0) {
                continue;
            }
            if (*clients[0]->match.hash(tick) != server_hashes[tick]) {
                std::printf("tick %llu differs\n", static_cast<unsigned long long>(tick));
                return 1;
            }
            ++compared;
        }
        checked_until = stats.confirmed;
    }
    const hh_match_stats stats = clients[0]->match.stats();
    std::printf("%llu ticks equal, %llu rollbacks, %llu grips; %d sounds, %d in the feed\n",
                static_cast<unsigned long long>(compared),
                static_cast<unsigned long long>(stats.rollbacks),
                static_cast<unsigned long long>(server.game.state.grips), sounds, feed);
    return compared > 200 && stats.rollbacks > 50 && feed > 4 && sounds >= feed && farthest_m > 1.0
               ? 0
               : 1;
}

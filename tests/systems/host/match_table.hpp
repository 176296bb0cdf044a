#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>
#include <handhold/match.hpp>
#include <handhold/math.hpp>

#include "tests/systems/host/host_scene.hpp"
#include "tests/systems/match/simulated_network.hpp"

// A match of two players over the C interface: a server and two clients, each with a world and a
// game of its own, and a simulated network between them.
namespace handhold::test {

inline constexpr std::size_t k_seats = 2;
inline constexpr std::size_t k_host_seat = k_seats;  // the server's place in the network

// The game's own state: a score, and a code that players type, which opens a door.
struct TableState {
    std::uint64_t score = 0;  // grips so far
    std::array<std::uint32_t, 3> code{};
    std::array<std::uint32_t, k_seats> buttons{};  // of the tick before
    std::uint64_t opened = 0;
    std::uint64_t events = 0;  // a hash of all events

    std::uint64_t hash() const {
        std::uint64_t sum = events;
        for (const std::uint64_t part :
             {score, opened, std::uint64_t{code[0]}, std::uint64_t{code[1]}, std::uint64_t{code[2]},
              std::uint64_t{buttons[0]}, std::uint64_t{buttons[1]}}) {
            sum = (sum ^ part) * 0x100000001b3ULL;
        }
        return sum;
    }
    void note(std::uint64_t part) { events = (events ^ part) * 0x100000001b3ULL; }
    void note(double part) { note(static_cast<std::uint64_t>(std::llround(part * 1e9))); }
};

// Right hands grip a drawer each and move it beyond its limits. Left hands pull one bar. A ball
// flies against the bar again whenever the code is right.
struct TableScene {
    hh::World world;
    std::array<hh::Player, k_seats> players{};
    hh::Body ball{};

    TableScene() {
        hh_body_def bar = hh::body_def();
        bar.name = "bar";
        bar.kind = HH_DYNAMIC;
        bar.mass_kg = 4.0;
        bar.shape = *world.add_box({0.6, 0.06, 0.1});
        bar.pose.position = {0.3, 1.2, -0.6};
        (void)world.add(bar);
        hh_body_def ball_def = hh::body_def();
        ball_def.name = "ball";
        ball_def.kind = HH_DYNAMIC;
        ball_def.mass_kg = 0.5;
        ball_def.shape = *world.add_sphere(0.08);
        ball_def.pose.position = {0.3, 1.2, -0.95};
        ball = *world.add(ball_def);
        for (std::size_t seat = 0; seat < k_seats; ++seat) {
            const double x = static_cast<double>(seat);
            const std::string number = std::to_string(seat);
            hh_player_def player = hh::player_def();
            const std::string player_name = "player" + number;
            player.name = player_name.c_str();
            player.origin.position.x = x;
            players[seat] = *world.add(player);
            EXPECT_TRUE(world.use_wrists(players[seat]));
            const std::string drawer_name = "drawer" + number;
            hh_body_def drawer = crate(world, {x + 0.25, 1.65, -0.6});
            drawer.name = drawer_name.c_str();
            hh_joint_def rail = hh::joint_def();
            rail.kind = HH_SLIDER;
            rail.body_b = *world.add(drawer);
            constexpr double k_half = 0.7071067811865476;
            rail.frame = hh::pose_at(drawer.pose.position, {0.0, k_half, 0.0, k_half});
            rail.limited = 1;
            rail.lower = -0.05;
            rail.upper = 0.05;
            EXPECT_TRUE(world.add(rail));
        }
    }
};

inline hh::Sample table_sample(std::size_t seat, double t) {
    hh::Sample made = hh::sample();
    made.time_s = t;
    const double phase = 1.3 * static_cast<double>(seat);
    made.head.position = {0.02 * std::sin(t + phase), 1.6, 0.0};
    made.hands[HH_LEFT] = hh::pose_at({-0.2 + 0.05 * std::sin(2.0 * t + phase), 1.2,
                                       -0.43 + 0.08 * std::max(0.0, std::sin(3.0 * t + phase))},
                                      k_palm_ahead);
    made.hands[HH_RIGHT] = hh::pose_at({0.25, 1.65, -0.43 + 0.1 * std::sin(4.0 * t)}, k_palm_ahead);
    made.grab[HH_LEFT] = std::fmod(t + 0.4 * static_cast<double>(seat), 1.7) > 0.5;
    made.grab[HH_RIGHT] = std::fmod(t + phase, 2.3) > 0.4;
    return made;
}
// The first player types the code's digits in turn; the second one presses another button.
inline std::uint32_t table_buttons(std::size_t seat, double t) {
    const double at = std::fmod(t, 0.9);
    if (seat > 0) {
        return at < 0.2 ? 8U : 0U;
    }
    return std::fmod(at, 0.3) < 0.08 ? 1U << static_cast<unsigned>(at / 0.3) : 0U;
}

struct TableMachine {
    TableScene scene;
    hh::MatchGame<TableState> game;
    hh_match_game callbacks;
    hh::Match match;
    // A planted fault: something that a rollback does not restore.
    std::uint64_t forgotten = 0;
    bool plants_in_game = false;
    bool plants_in_world = false;

    explicit TableMachine(hh_match_role role, std::uint32_t slot = 0)
        : game([this](TableState& state, std::uint64_t tick,
                      std::span<const std::uint32_t> buttons) { step(state, tick, buttons); }),
          callbacks(game.callbacks()) {
        hh_match_def def = hh::match_def();
        def.role = role;
        def.slot = slot;
        match = hh::Match(scene.world, scene.players, def, &callbacks);
        EXPECT_TRUE(match.is_valid()) << hh_last_error();
    }

  private:
    void step(TableState& state, std::uint64_t tick, std::span<const std::uint32_t> buttons) {
        ++forgotten;
        for (const hh::Event& event : scene.world.events()) {
            state.score += event.kind == HH_EVENT_GRABBED ? 1 : 0;
            for (const std::uint64_t part :
                 {tick, static_cast<std::uint64_t>(event.kind),
                  static_cast<std::uint64_t>(event.reason), std::uint64_t{event.player.index},
                  std::uint64_t{event.body.index}, std::uint64_t{event.held.index},
                  std::uint64_t{event.joint.index}}) {
                state.note(part);
            }
            state.note(event.position.x + event.position.y + event.position.z);
            state.note(event.impulse_ns);
        }
        for (std::size_t seat = 0; seat < buttons.size(); ++seat) {
            for (std::uint32_t digit = 0; digit < 3; ++digit) {
                const std::uint32_t bit = 1U << digit;
                if ((buttons[seat] & bit) != 0 && (state.buttons[seat] & bit) == 0) {
                    state.code = {state.code[1], state.code[2], digit};
                }
            }
            state.buttons[seat] = buttons[seat];
        }
        if (state.code == std::array<std::uint32_t, 3>{0, 1, 2}) {
            state.code = {};
            ++state.opened;
            EXPECT_TRUE(scene.world.teleport(scene.ball, hh::pose_at({0.3, 1.2, -0.95})));
            EXPECT_TRUE(scene.world.set_velocity(
                scene.ball, {0.0, 0.1 * static_cast<double>(state.opened % 3), 1.5}));
        }
        if (plants_in_game && forgotten == 60) {
            ++state.score;
        }
        if (plants_in_world && forgotten == 60) {
            EXPECT_TRUE(scene.world.set_velocity(scene.ball, {0.0, 0.0, 0.7}));
        }
    }
};

// An event by what makes it the same one.
using EventKey = std::tuple<std::uint64_t, int, int, std::uint32_t, int, std::uint32_t,
                            std::uint32_t, std::uint32_t, std::uint32_t>;
inline EventKey key_of(const hh_match_event& one) {
    const hh::Event& e = one.event;
    return {one.tick,     e.kind,        e.reason,     e.player.index, e.side,
            e.body.index, e.other.index, e.held.index, e.joint.index};
}

class TableMatch {
  public:
    TableMatch(const lab::NetworkTraits& traits, std::uint64_t seed,
               std::size_t seats_at_start = k_seats)
        : network(traits, match_test::seed_of(seed)) {
        for (std::size_t seat = 0; seat < k_seats; ++seat) {
            clients.push_back(
                std::make_unique<TableMachine>(HH_MATCH_CLIENT, static_cast<std::uint32_t>(seat)));
            is_here[seat] = seat < seats_at_start;
            if (is_here[seat]) {
                EXPECT_TRUE(server.match.connect(static_cast<std::uint32_t>(seat)));
            }
        }
        note_server();
    }

    void play(double seconds) {
        constexpr double k_look_s = 1.0 / 360.0;
        const auto looks = static_cast<int>(std::lround(seconds / k_look_s));
        for (int i = 0; i < looks; ++i) {
            now_s += k_look_s;
            network.deliver(
                now_s, [&](std::size_t from, std::size_t to, std::span<const std::byte> packet) {
                    if (to == k_host_seat) {
                        EXPECT_TRUE(server.match.receive_from(static_cast<std::uint32_t>(from),
                                                              now_s, packet));
                    } else if (is_here[to]) {
                        EXPECT_TRUE(clients[to]->match.receive(packet));
                    }
                });
            step_server();
            ++looks_;
            for (std::size_t seat = 0; seat < k_seats && looks_ % 4 == 0; ++seat) {
                if (is_here[seat]) {
                    EXPECT_TRUE(server.match.packet_to(static_cast<std::uint32_t>(seat), packet_));
                    send(k_host_seat, seat);
                }
            }
            for (std::size_t seat = 0; seat < k_seats; ++seat) {
                if (is_here[seat] && looks_ % 4 == static_cast<int>(seat) + 1) {
                    step_client(seat);
                }
            }
        }
    }

    // The server's state, with the game's, travels to the client for a time.
    void join(std::size_t seat, double travels_s = 0.0) {
        std::vector<std::byte> state;
        ASSERT_TRUE(server.match.state(static_cast<std::uint32_t>(seat), state));
        const TableState game = server.game.state;
        if (!is_here[seat]) {
            ASSERT_TRUE(server.match.connect(static_cast<std::uint32_t>(seat)));
        }
        play(travels_s);
        TableMachine& client = *clients[seat];
        ASSERT_TRUE(client.match.join(state)) << hh_last_error();
        client.game.state = game;
        is_here[seat] = true;
        take_events(seat);
        checked_until[seat] = client.match.stats().tick;
        joined_at[seat] = checked_until[seat];
    }

    lab::SimulatedNetwork network;
    TableMachine server{HH_MATCH_SERVER};
    std::vector<std::unique_ptr<TableMachine>> clients;
    std::array<bool, k_seats> is_here{};
    std::array<std::uint64_t, k_seats> checked_until{};
    std::array<std::uint64_t, k_seats> joined_at{};
    std::array<std::map<EventKey, int>, k_seats> predicted;  // not confirmed yet
    std::array<std::vector<EventKey>, k_seats> confirmed;
    std::vector<EventKey> server_events;
    std::uint64_t compared = 0;
    std::uint64_t retracted = 0;
    double now_s = 0.0;
    std::vector<std::vector<std::byte>> recorded;  // packets to the server, while records is set
    bool records = false;
    std::uint64_t server_hash(std::uint64_t tick) const { return server_hashes_.at(tick); }

  private:
    void send(std::size_t from, std::size_t to) {
        if (records && to == k_host_seat) {
            recorded.push_back(packet_);
        }
        network.send(from, to, packet_, now_s);
    }
    void note_server() {
        const std::uint64_t tick = server.match.stats().tick;
        server_hashes_[tick] = *server.match.hash(tick);
    }
    // Almost always one tick a call; only the last one of a call is compared.
    void step_server() {
        for (;;) {
            const std::uint64_t before = server.match.stats().tick;
            const hh::Maybe<std::uint32_t> ticks = server.match.confirm(now_s);
            ASSERT_TRUE(ticks);
            if (*ticks == 0) {
                return;
            }
            ASSERT_LE(*ticks, 16U);
            for (const hh_match_event& event : server.match.events()) {
                EXPECT_EQ(event.state, HH_MATCH_CONFIRMED);
                server_events.push_back(key_of(event));
            }
            EXPECT_EQ(server.match.stats().tick, before + *ticks);
            note_server();
        }
    }
    void step_client(std::size_t seat) {
        TableMachine& client = *clients[seat];
        const std::uint32_t ticks = *client.match.ticks_due(1.0 / 90.0);
        for (std::uint32_t i = 0; i < ticks; ++i) {
            const double end_s = client.scene.world.time_s() + 1.0 / 90.0;
            const hh::Sample sample = table_sample(seat, end_s);
            hh_match_input input = hh::match_input({&sample, 1}, table_buttons(seat, end_s));
            input.is_hidden = i + 1 < ticks;
            ASSERT_TRUE(client.match.advance(input));
            take_events(seat);
        }
        check(seat);
        ASSERT_TRUE(client.match.packet(packet_));
        send(seat, k_host_seat);
    }
    void take_events(std::size_t seat) {
        for (const hh_match_event& event : clients[seat]->match.events()) {
            const EventKey key = key_of(event);
            if (event.state == HH_MATCH_PREDICTED) {
                ++predicted[seat][key];
                continue;
            }
            EXPECT_GT(predicted[seat][key], 0) << "tick " << event.tick;  // told before
            --predicted[seat][key];
            if (event.state == HH_MATCH_CONFIRMED) {
                confirmed[seat].push_back(key);
            } else {
                ++retracted;
            }
        }
    }
    void check(std::size_t seat) {
        const hh::Match& match = clients[seat]->match;
        const hh_match_stats stats = match.stats();
        for (std::uint64_t tick = checked_until[seat] + 1; tick <= stats.confirmed; ++tick) {
            const auto known = server_hashes_.find(tick);
            if (known == server_hashes_.end() || tick + HH_MATCH_PLACES <= stats.tick) {
                continue;
            }
            ASSERT_EQ(*match.hash(tick), known->second) << "seat " << seat << ", tick " << tick;
            ++compared;
        }
        checked_until[seat] = std::max(checked_until[seat], stats.confirmed);
    }

    std::map<std::uint64_t, std::uint64_t> server_hashes_;
    std::vector<std::byte> packet_;
    int looks_ = 0;
};

}  // namespace handhold::test

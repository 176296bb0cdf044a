#include <deque>
#include <memory>
#include <vector>

#include <gtest/gtest.h>
#include <handhold/match.hpp>

#include "game/arena/arena_match.hpp"
#include "game/levels/built_in_scenes.hpp"
#include "game/net/match_scene.hpp"
#include "game/net/peer_hands.hpp"
#include "game/scene/random.hpp"

namespace handhold {
namespace arena_test {

constexpr double k_dt_s = 1.0 / 90.0;

Scene arena() { return std::move(*make_built_in_scene("arena")); }

TEST(Arena, DiscInAGoalScoresOnceAndReturnsToTheMiddle) {
    for (const ArenaTeam scorer : {ArenaTeam::blue, ArenaTeam::orange}) {
        Scene scene = arena();
        const hh::Vec3 goal = goal_of(other_team(scorer));
        const hh::Vec3 out = hh::normalized(goal);
        ASSERT_TRUE(scene.host.teleport(scene.arena->plan.disc, hh::pose_at(goal - 0.5 * out)));
        ASSERT_TRUE(scene.host.set_velocity(scene.arena->plan.disc, 5.0 * out));
        for (int i = 0; i < 90; ++i) {
            ASSERT_TRUE(scene.host.step(k_dt_s));
            scene.arena->step(scene.host, scene.host.frame());
        }
        const ArenaState& state = scene.arena->state;
        EXPECT_EQ(state.score[static_cast<std::size_t>(scorer)], 1U);
        EXPECT_EQ(state.score[static_cast<std::size_t>(other_team(scorer))], 0U);
        // 0.5 m at 5 m/s is 9 ticks; which of two ticks is a matter of rounding.
        EXPECT_NEAR(static_cast<double>(state.goal_tick), 9.0, 1.0);
        EXPECT_EQ(state.reset_tick, state.goal_tick);
        EXPECT_LT(hh::length(scene.host.pose(scene.arena->plan.disc)->position), 1e-6);
    }
}

TEST(Arena, DiscBesideOrBehindTheRingDoesNotScore) {
    EXPECT_FALSE(scores_at({k_goal_radius_m + 0.01, 0.0, k_goal_z_m + 0.5}));
    EXPECT_FALSE(scores_at({0.0, 0.0, k_goal_z_m - 0.01}));
    EXPECT_FALSE(scores_at({0.0, 0.0, 0.0}));
    EXPECT_EQ(scores_at({0.3, 0.0, k_goal_z_m + 0.5}), ArenaTeam::orange);
    EXPECT_EQ(scores_at({0.3, 0.0, -k_goal_z_m - 0.5}), ArenaTeam::blue);
}

TEST(Arena, DiscThatLeavesTheHallReturnsWithoutAScore) {
    Scene scene = arena();
    ASSERT_TRUE(scene.host.teleport(scene.arena->plan.disc, hh::pose_at({0.0, 9.0, 0.0})));
    scene.arena->step(scene.host, 7);
    EXPECT_EQ(scene.arena->state.reset_tick, 7U);
    EXPECT_EQ(scene.arena->state.goal_tick, 0U);
    EXPECT_EQ(scene.arena->state.score, (std::array<std::uint32_t, 2>{}));
}

TEST(Arena, BoardsShowAnyScore) {
    Scene scene = arena();
    for (std::uint32_t score = 0; score < 100; ++score) {
        const std::array<std::uint32_t, 2> wanted = {score, 99 - score};
        for (const ArenaDrum& drum : scene.arena->plan.drums) {
            ASSERT_TRUE(scene.host.teleport(
                drum.body, drum_pose(drum, wanted[static_cast<std::size_t>(drum.team)])));
        }
        scene.arena->read_boards(scene.host);
        ASSERT_EQ(scene.arena->state.score, wanted);
    }
}

TEST(Arena, StateIsReadAsWrittenAndOtherBytesAreRefused) {
    const ArenaState state{{3, 0xfffffffe}, 0x123456789abcULL, ~std::uint64_t{0}};
    std::vector<std::byte> bytes;
    write_arena_state(state, bytes);
    ASSERT_EQ(bytes.size(), k_arena_state_bytes);
    EXPECT_EQ(read_arena_state(bytes), state);
    for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
        std::vector<std::byte> flipped = bytes;
        flipped[bit / 8] ^= static_cast<std::byte>(1U << (bit % 8));
        EXPECT_FALSE(read_arena_state(flipped)) << bit;
    }
    bytes.pop_back();
    EXPECT_FALSE(read_arena_state(bytes));
}

TEST(Arena, EightPlayersBeginOnTheirTeamsSides) {
    const MatchScene match = std::move(make_match_scene(arena(), 8, 1).value());
    for (std::size_t slot = 0; slot < 8; ++slot) {
        const hh::Vec3 place = match.scene.host.pose(match.players[slot])->origin.position;
        const hh::Vec3 own = goal_of(team_of(slot));
        EXPECT_GT(place.z * own.z, 0.0) << slot;
        EXPECT_EQ(team_of(match.scene.host, match.players[slot]), team_of(slot));
    }
}

// Launches the disc at one of the goals soon after each reset: a function of tick and state.
struct Launches {
    std::vector<std::uint64_t> resets;
    ArenaState state;
    std::uint64_t hash = 0;
};
Launches run_launches(std::uint32_t sync_ticks, std::uint64_t seed) {
    MatchScene made = std::move(make_match_scene(arena(), 2, 1).value());
    hh::World& world = made.scene.host;
    const ArenaPlan plan = made.scene.arena->plan;
    hh::MatchGame<ArenaState> game([&world, &plan, seed](ArenaState& state, std::uint64_t tick,
                                                         std::span<const std::uint32_t>) {
        if (tick == state.reset_tick + 5) {
            Random random = Random::of(seed + tick);
            const hh::Vec3 goal = goal_of(random.chance(0.5) ? ArenaTeam::blue : ArenaTeam::orange);
            (void)world.teleport(plan.disc, hh::pose_at(0.9 * goal));
            const double speed_mps = random.between(3.0, 20.0);
            const double across_mps = random.between(0.0, 3.0);
            const hh::Vec3 across = random.direction();
            (void)world.set_velocity(plan.disc,
                                     speed_mps * hh::normalized(goal) + across_mps * across);
        } else if (tick > state.reset_tick + 200) {
            (void)world.teleport(plan.disc, hh::pose_at({0.0, 20.0, 0.0}));
        }
        ArenaGame::step(plan, world, tick, state);
    });
    const hh_match_game callbacks = game.callbacks();
    hh_match_def def = hh::match_def();
    def.role = HH_MATCH_SYNC_TEST;
    def.sync_ticks = sync_ticks;
    hh::Match match(world, made.players, def, &callbacks);
    EXPECT_TRUE(match.is_valid());
    Launches out;
    const std::vector<hh_match_input> inputs(2, hh::match_input({}));
    for (int i = 0; i < 600; ++i) {
        hh_match_difference difference{};
        EXPECT_EQ(hh_match_sync_test(match.get(), inputs.data(), inputs.size(), &difference),
                  HH_OK);
        EXPECT_EQ(difference.tick, 0U);
        if (out.resets.empty() ? game.state.reset_tick != 0
                               : game.state.reset_tick != out.resets.back()) {
            out.resets.push_back(game.state.reset_tick);
        }
    }
    out.state = game.state;
    out.hash = *match.hash(match.stats().tick);
    return out;
}

TEST(Arena, AnyMixtureOfRollbacksGivesTheSameScoreAndResetTicks) {
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
        const Launches once = run_launches(1, seed);
        EXPECT_GE(once.state.score[0] + once.state.score[1], 2U);
        EXPECT_GE(once.resets.size(), 3U);
        for (const std::uint32_t ticks : {2U, 9U, 30U}) {
            const Launches again = run_launches(ticks, seed);
            EXPECT_EQ(again.resets, once.resets) << ticks;
            EXPECT_EQ(again.state, once.state) << ticks;
            EXPECT_EQ(again.hash, once.hash) << ticks;
        }
    }
}

// One machine of a match: a world, the rules, and a bot's hands.
struct Machine {
    MatchScene made;
    std::unique_ptr<ArenaMatch> rules;
    hh::Match match;
    std::unique_ptr<ClimberHands> hands;
    PeerInput input;
    std::uint64_t compared = 0;
    std::uint64_t different = 0;

    Machine(std::size_t players, hh_match_role role, std::uint32_t slot)
        : made(std::move(make_match_scene(arena(), players, 1).value())),
          rules(std::make_unique<ArenaMatch>(made.scene.host, *made.scene.arena)) {
        hh_match_def def = hh::match_def();
        def.role = role;
        def.slot = slot;
        const hh_match_game game = rules->callbacks();
        match = hh::Match(made.scene.host, made.players, def, &game);
        if (role == HH_MATCH_CLIENT) {
            hands = std::make_unique<ClimberHands>(made.scene, made.players[slot], 11 + slot);
        }
    }
    void advance(double elapsed_s) {
        const std::uint32_t due = *match.ticks_due(elapsed_s);
        for (std::uint32_t i = 0; i < due; ++i) {
            input.samples.clear();
            (*hands)(made.scene.host.time_s() + k_dt_s, input);
            hh_match_input tick = hh::match_input(input.samples);
            tick.commands = input.commands;
            tick.is_hidden = 1;
            ASSERT_TRUE(match.advance(tick));
        }
    }
};

struct Packet {
    double at_s;
    std::vector<std::byte> bytes;
};

// A match without sockets and without the wall's clock: packets take 40 to 90 ms, 5 % are lost.
TEST(Arena, BotsScoreInAMatchAndAllMachinesAgree) {
    constexpr std::size_t k_players = 4;
    constexpr double k_longest_s = 120.0;
    Machine server(k_players, HH_MATCH_SERVER, 0);
    std::vector<std::unique_ptr<Machine>> peers;
    std::vector<std::deque<Packet>> up(k_players);
    std::vector<std::deque<Packet>> down(k_players);
    std::vector<std::uint64_t> hashes(1);
    for (std::uint32_t slot = 0; slot < k_players; ++slot) {
        peers.push_back(std::make_unique<Machine>(k_players, HH_MATCH_CLIENT, slot));
        ASSERT_TRUE(server.match.connect(slot));
    }
    Random network = Random::of(5);
    const auto send = [&network](std::deque<Packet>& queue, double now_s,
                                 const std::vector<std::byte>& bytes) {
        const double delay_s = network.between(0.04, 0.09);
        if (!network.chance(0.05)) {
            queue.push_back({now_s + delay_s, bytes});
        }
    };
    std::vector<std::byte> packet;
    std::uint64_t rollbacks = 0;
    for (double now_s = 0.0; now_s < k_longest_s; now_s += k_dt_s) {
        for (std::uint32_t slot = 0; slot < k_players; ++slot) {
            Machine& peer = *peers[slot];
            for (; !down[slot].empty() && down[slot].front().at_s <= now_s;
                 down[slot].pop_front()) {
                (void)peer.match.receive(down[slot].front().bytes);
            }
            peer.advance(k_dt_s);
            if (peer.match.packet(packet)) {
                send(up[slot], now_s, packet);
            }
            for (; !up[slot].empty() && up[slot].front().at_s <= now_s; up[slot].pop_front()) {
                (void)server.match.receive_from(slot, now_s, up[slot].front().bytes);
            }
        }
        while (server.match.confirm(now_s).value_or(0) > 0) {
        }
        for (std::uint32_t slot = 0; slot < k_players; ++slot) {
            if (server.match.packet_to(slot, packet)) {
                send(down[slot], now_s, packet);
            }
        }
        const std::uint64_t tick = server.match.stats().tick;
        hashes.resize(tick + 1);
        hashes[tick] = *server.match.hash(tick);
        for (const auto& peer : peers) {
            const hh_match_stats stats = peer->match.stats();
            const auto hash = peer->match.hash(stats.confirmed);
            if (hash && stats.confirmed < hashes.size() && hashes[stats.confirmed] != 0) {
                ++peer->compared;
                peer->different += *hash != hashes[stats.confirmed] ? 1U : 0U;
            }
        }
        const ArenaState& state = server.rules->state();
        if (state.goal_tick != 0 && tick > state.goal_tick + 180) {
            break;
        }
    }
    const ArenaState& state = server.rules->state();
    EXPECT_GE(state.score[0] + state.score[1], 1U);
    for (const auto& peer : peers) {
        rollbacks += peer->match.stats().rollbacks;
        EXPECT_EQ(peer->different, 0U);
        EXPECT_GT(peer->compared, 400U);
        EXPECT_EQ(peer->rules->state().score, state.score);
        EXPECT_EQ(peer->rules->state().goal_tick, state.goal_tick);
    }
    EXPECT_GT(rollbacks, 100U);
    EXPECT_EQ(server.match.stats().out_of_sync, 0U);
    EXPECT_GT(server.match.stats().hashes, 4U);
}

}  // namespace arena_test
}  // namespace handhold

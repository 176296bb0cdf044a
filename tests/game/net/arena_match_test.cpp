// The arena over real sockets: goals, and joining while there is a score.
#include <gtest/gtest.h>

#include "game/arena/arena_game.hpp"
#include "game/levels/built_in_scenes.hpp"
#include "tests/game/net/loopback_match.hpp"

namespace handhold::arena_match_test {
namespace {

using test::LoopbackMatch;
using test::LoopbackPeer;

class ArenaMatchTest : public testing::Test {
  protected:
    void SetUp() override {
        if (!has_network()) {
            GTEST_SKIP() << "built without a network";
        }
    }
};

MatchScene arena_for(std::size_t players) {
    return std::move(
        make_match_scene(std::move(*make_built_in_scene("arena")), players, 1).value());
}

// The disc flies at a goal at the start, so that the first goal is certain.
MatchScene arena_with_a_shot(std::size_t players) {
    Scene scene = std::move(*make_built_in_scene("arena"));
    const hh::Vec3 goal = goal_of(ArenaTeam::orange);
    (void)scene.host.teleport(scene.arena->plan.disc, hh::pose_at(0.8 * goal));
    (void)scene.host.set_velocity(scene.arena->plan.disc, 8.0 * hh::normalized(goal));
    return std::move(make_match_scene(std::move(scene), players, 1).value());
}

const ArenaState& state_of(const LoopbackPeer& peer) { return peer.scene.scene.arena->state; }

TEST_F(ArenaMatchTest, WhoJoinsAfterAGoalHasTheScore) {
    LoopbackMatch match(4, {}, {}, arena_with_a_shot);
    LoopbackPeer& first = match.add_peer(1);
    const ArenaState& of_server = match.scene().scene.arena->state;
    ASSERT_TRUE(match.run_until(20.0, [&] { return match.all_play(); }));
    ASSERT_TRUE(match.run_until(20.0, [&] { return of_server.score[0] == 1; }));
    LoopbackPeer& late = match.add_peer(2);
    LoopbackPeer watcher(4, 3, {}, arena_with_a_shot);
    watcher.settings.watches = true;
    watcher.connect(match.link());
    match.others = [&] { watcher.poll(); };
    ASSERT_TRUE(match.run_until(20.0, [&] { return match.all_play() && watcher.plays(); }));
    match.run(2.0);
    for (const LoopbackPeer* peer : {&first, &late}) {
        EXPECT_EQ(state_of(*peer).score, of_server.score);
        EXPECT_EQ(state_of(*peer).goal_tick, of_server.goal_tick);
        EXPECT_EQ(peer->different, 0U);
        EXPECT_GT(peer->compared, 20U);
    }
    EXPECT_EQ(state_of(watcher).score, of_server.score);
    EXPECT_EQ(match.server->match().stats().out_of_sync, 0U);
    EXPECT_GT(match.server->match().stats().hashes, 0U);
}

// Until somebody throws the disc into a goal: about a minute.
TEST_F(ArenaMatchTest, BotsPlayUntilAGoalOverSockets) {
    HH_NEEDS_REAL_TIME();
    LoopbackMatch match(4, {}, {}, arena_for);
    for (const std::uint64_t number : {11U, 12U, 13U, 14U}) {
        match.add_peer(number);
    }
    const ArenaState& of_server = match.scene().scene.arena->state;
    ASSERT_TRUE(match.run_until(20.0, [&] { return match.all_play(); }));
    ASSERT_TRUE(match.run_until(240.0, [&] { return of_server.goal_tick != 0; }));
    match.run(2.0);
    for (const auto& peer : match.peers) {
        EXPECT_EQ(state_of(*peer).score, of_server.score);
        EXPECT_EQ(state_of(*peer).goal_tick, of_server.goal_tick);
        EXPECT_EQ(peer->different, 0U);
        EXPECT_GT(peer->compared, 100U);
    }
    RecordProperty("goal_tick", static_cast<int>(of_server.goal_tick));
}

}  // namespace
}  // namespace handhold::arena_match_test

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "game/arena/arena_game.hpp"
#include "game/climber/crowd.hpp"
#include "game/levels/built_in_scenes.hpp"
#include "game/net/match_scene.hpp"

namespace handhold::arena_play_test {
namespace {

constexpr double k_play_dt_s = 1.0 / 90.0;

// Teams whose players hold the disc.
std::size_t teams_with(const hh::World& world, hh::Body disc) {
    std::array<bool, k_arena_teams> has{};
    std::size_t index = 0;
    for (const hh::Player player : world.players()) {
        const ArenaTeam team = team_of(index++);
        for (const hh::Side side : {HH_LEFT, HH_RIGHT}) {
            const auto hand = world.hand(player, side);
            has[static_cast<std::size_t>(team)] |= hand && hand->body == disc;
        }
    }
    return static_cast<std::size_t>(std::ranges::count(has, true));
}

TEST(ArenaPlay, ClimbersDoNotPullAtTheDiscForLong) {
    double longest_s = 0.0;
    double contested_s = 0.0;
    for (const std::uint64_t seed : {1U, 2U}) {
        MatchScene made =
            std::move(make_match_scene(std::move(*make_built_in_scene("arena")), 8, seed).value());
        Scene& scene = made.scene;
        Crowd crowd(scene.host, made.players, seed);
        std::vector<hh_player_input> inputs;
        for (const hh::Player player : made.players) {
            inputs.push_back(hh::input(player, {}));
        }
        double since_s = 0.0;
        for (int frame = 0; frame < 40 * 90; ++frame) {
            crowd.drive(sight_of(scene), scene.host.time_s() + k_play_dt_s, inputs);
            ASSERT_TRUE(scene.host.step(k_play_dt_s, inputs));
            scene.arena->step(scene.host, scene.host.frame());
            const bool is_contested = teams_with(scene.host, scene.arena->plan.disc) == 2;
            since_s = is_contested ? since_s + k_play_dt_s : 0.0;
            contested_s += is_contested ? k_play_dt_s : 0.0;
            longest_s = std::max(longest_s, since_s);
        }
    }
    EXPECT_GT(contested_s, 0.5);  // else nothing was tested
    EXPECT_LT(longest_s, 5.0);
    RecordProperty("longest_ms", static_cast<int>(1e3 * longest_s));
    RecordProperty("contested_ms", static_cast<int>(1e3 * contested_s));
}

}  // namespace
}  // namespace handhold::arena_play_test

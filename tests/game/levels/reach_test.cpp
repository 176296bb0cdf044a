// The bay's session shows a distance grab that ends in the hand, one that is refused, one that is
// released, and hands whose tracked and shown poses differ.
#include <algorithm>
#include <array>

#include <gtest/gtest.h>

#include "game/levels/built_in_scenes.hpp"
#include "game/render/ghost_hands.hpp"
#include "game/run/session_run.hpp"

namespace handhold::reach_test {
namespace {

class Reach : public ::testing::Test {
  public:
    void play() {
        scene.emplace(*make_built_in_scene("reach"));
        const PlayerEntities player =
            add_scene_player(*scene, {"player", from_host(scene->spawns.front().pose_ws), 80.0});
        const Recording recording = *make_built_in_session("reach");
        run_session(*scene, player_ids({&player, 1}), &recording, {},
                    [&](const Scene&, const FrameLog& frame) { watch(player, frame); });
    }
    Entity find(const char* name) const {
        return find_by_id(scene->world(), persistent_id_from_name(name));
    }
    Vec3 place(const char* name) const {
        return scene->world().body_pose.at(find(name)).pose_ws.position;
    }

    std::optional<Scene> scene;
    std::array<std::uint64_t, static_cast<std::size_t>(Fallback::count)> counted{};
    double canister_held_s = 0.0;
    double ball_fastest_mps = 0.0;
    double rail_ghost = 0.0;   // most visible ghost beside the rail,
    double other_ghost = 0.0;  // most visible ghost before the rail, where hands only grip

  private:
    void watch(const PlayerEntities& player, const FrameLog& frame) {
        const World& world = scene->world();
        for (std::size_t i = 0; i < counted.size(); ++i) {
            counted[i] += frame.stats.fallbacks[i];
        }
        const Grab& right = world.grab.at(player.hands[1]);
        if (right.kind == GripKind::held && right.body == find("canister")) {
            canister_held_s += 1.0 / 90.0;
        }
        ball_fastest_mps =
            std::max(ball_fastest_mps, world.body_velocity.at(find("ball")).linear_mps.norm());
        for (const RenderPose::Hand& hand : world.render_pose.at(player.player).hands) {
            double& most = frame.t_s < 11.2 ? other_ghost : rail_ghost;
            most = std::max(most, ghost_share(hand, {}));
        }
    }
};

TEST_F(Reach, SessionTakesTheCanisterLeavesTheSafeAndLetsTheBallFly) {
    play();
    EXPECT_GT(canister_held_s, 1.5);
    EXPECT_EQ(counted[static_cast<std::size_t>(Fallback::pull_refused_heavy)], 1U);
    EXPECT_EQ(counted[static_cast<std::size_t>(Fallback::pull_lost)], 0U);
    EXPECT_LT((place("safe") - Vec3(0.12, 0.62, -1.9)).norm(), 1e-9);
    EXPECT_GT(ball_fastest_mps, 2.0);
}

TEST_F(Reach, GhostsAppearWhereHandsArePulledApartAndNotInOrdinaryGrips) {
    play();
    EXPECT_EQ(other_ghost, 0.0);
    EXPECT_GT(rail_ghost, 0.5);
}

// Sessions in which hands only hold on.
class OrdinaryGrips : public ::testing::TestWithParam<const char*> {};
TEST_P(OrdinaryGrips, HaveNoGhosts) {
    Scene scene = *make_built_in_scene(GetParam());
    const PlayerEntities player =
        add_scene_player(scene, {"player", from_host(scene.spawns.front().pose_ws), 80.0});
    const Recording recording = *make_built_in_session(GetParam());
    double most = 0.0;
    RunSettings settings;
    settings.keep_frames = false;
    run_session(scene, player_ids({&player, 1}), &recording, settings,
                [&](const Scene&, const FrameLog&) {
                    for (const auto& hand : scene.world().render_pose.at(player.player).hands) {
                        most = std::max(most, ghost_share(hand, {}));
                    }
                });
    EXPECT_EQ(most, 0.0);
}
INSTANTIATE_TEST_SUITE_P(Scenes, OrdinaryGrips, testing::Values("station", "ship", "robot"));

}  // namespace
}  // namespace handhold::reach_test

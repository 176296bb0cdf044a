// The session of two players: one takes the other by the forearm, then by the thigh.
#include <algorithm>
#include <cstddef>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "game/levels/built_in_scenes.hpp"
#include "game/run/session_run.hpp"

namespace handhold::together_test {
namespace {

struct Together {
    Scene scene = *make_built_in_scene("together");
    std::vector<PlayerEntities> players;
    std::set<BodyPart> gripped;
    std::ptrdiff_t most_touches = 0;  // fingers of the gripping hand
    double worst_error_m = 0.0;
    double fastest_mps = 0.0;  // of the partner
    std::uint64_t state_hash = 0;

    explicit Together(int threads) {
        for (const ScenePlayerStart& start : scene.players) {
            players.push_back(add_scene_player(scene, start));
        }
        const Recording recording = *make_built_in_session("together");
        const std::vector<Recording> partners = make_built_in_partners("together");
        RunSettings settings;
        settings.threads = threads;
        settings.climbers_from = players.size();
        settings.more_recordings = {&partners.front()};
        state_hash = run_session(scene, player_ids(players), &recording, settings,
                                 [&](const Scene&, const FrameLog&) { watch(); })
                         .state_hash;
    }
    void watch() {
        const Entity hand = players[0].hands[index_of(HandSide::right)];
        const Grab& grab = scene.world().grab.at(hand);
        if (grab.kind == GripKind::player) {
            EXPECT_EQ(grab.body, players[1].player);
            gripped.insert(scene.world().body_hold.at(hand).part);
            worst_error_m = std::max(worst_error_m, grab.error_m);
            const auto& touches = scene.world().finger_pose.at(hand).touches;
            most_touches =
                std::max(most_touches, std::ptrdiff_t{std::ranges::count(touches, true)});
        }
        fastest_mps = std::max(
            fastest_mps, scene.world().player_velocity.at(players[1].player).linear_mps.norm());
    }
};

TEST(TogetherScene, HolderTakesThePartnerByArmAndLeg) {
    const Together played(1);
    EXPECT_EQ(played.gripped, (std::set{BodyPart::left_forearm, BodyPart::left_thigh}));
    EXPECT_LE(played.worst_error_m, 1e-6);
    EXPECT_GE(played.most_touches, 3);
    // The hand moves at up to 0.5 m/s and the held arm at as much.
    EXPECT_GT(played.fastest_mps, 0.1);
    EXPECT_LE(played.fastest_mps, 1.5);
}

TEST(TogetherSceneThreaded, HashIsEqualForOneAndTwoThreads) {
    EXPECT_EQ(Together(2).state_hash, Together(1).state_hash);
}

}  // namespace
}  // namespace handhold::together_test

// Players who mean harm among climbers who do not, in whole scenes, at frames of 1 to 100 ms.
// A long run: HANDHOLD_RANDOM_PLAY_FRAMES (of each scene), HANDHOLD_RANDOM_PLAY_SEED.
#include <algorithm>
#include <cstdlib>
#include <string>

#include <gtest/gtest.h>

#include "game/built_in_scenes.hpp"
#include "game/crowd.hpp"
#include "game/place_scene.hpp"
#include "tests/game/finite_world.hpp"
#include "tests/game/hostile_player.hpp"

namespace handhold {
namespace {

std::uint64_t number_from_environment(const char* name, std::uint64_t otherwise) {
    const char* const text = std::getenv(name);
    return text != nullptr ? std::strtoull(text, nullptr, 10) : otherwise;
}

struct PlayCase {
    const char* scene;
    std::size_t hostile;
    std::size_t climbers;
    std::uint64_t frames;
    bool enclosed;  // nobody can leave
};

class HostilePlay : public testing::TestWithParam<PlayCase> {};

// What moves at all, at most, against the scene's own velocity.
double fastest_player_mps(const World& world) {
    double fastest = 0.0;
    for (const PlayerVelocity& velocity : world.player_velocity.rows()) {
        fastest = std::max(fastest, (velocity.linear_mps - world.reference_velocity_mps).norm());
    }
    return fastest;
}
double fastest_body_mps(const World& world) {
    double fastest = 0.0;
    for (std::size_t row = 0; row < world.body.size(); ++row) {
        if (world.body.rows()[row].kind == BodyKind::free) {
            const Vec3& velocity = world.body_velocity.at(world.body.owners()[row]).linear_mps;
            fastest = std::max(fastest, (velocity - world.reference_velocity_mps).norm());
        }
    }
    return fastest;
}

TEST_P(HostilePlay, StaysFiniteBoundedAndLosesNobody) {
    const PlayCase& play = GetParam();
    const std::uint64_t seed = number_from_environment("HANDHOLD_RANDOM_PLAY_SEED", 1);
    const std::uint64_t frames =
        number_from_environment("HANDHOLD_RANDOM_PLAY_FRAMES", play.frames);
    Scene scene = *make_built_in_scene(play.scene);
    scene.tuning.locomotion.thruster_mps2 = 0.5;
    FrameCaches caches(*scene.shapes);
    std::vector<PlayerEntities> players;
    for (const Pose& origin_ws : spread_players(scene, caches, scene.spawns.front().pose_ws,
                                                play.hostile + play.climbers, seed)) {
        const std::string name = "player" + std::to_string(players.size());
        players.push_back(add_scene_player(scene, {name, origin_ws, 80.0}));
    }
    std::vector<HostilePlayer> hostile;
    for (std::size_t i = 0; i < play.hostile; ++i) {
        hostile.emplace_back(seed + i);
    }
    Crowd crowd(scene, std::span(players).subspan(play.hostile), seed);
    std::vector<PlayerInput> inputs(players.size());
    Random random(seed);
    StageStats stats;
    double fastest_player = 0.0;
    double fastest_body = 0.0;
    std::uint64_t grabs = 0;
    for (std::uint64_t frame = 0; frame < frames; ++frame) {
        // Mostly frames as they are, now and then anything between 1 and 100 ms.
        const double dt_s =
            random.chance(0.2) ? 0.001 + 0.099 * random.unit() * random.unit() : 1.0 / 90.0;
        const double start_s = scene.world.clock.t_s;
        for (std::size_t i = 0; i < play.hostile; ++i) {
            inputs[i] = hostile[i].play(players[i].player, start_s, start_s + dt_s);
        }
        crowd.drive(scene, caches, start_s + dt_s, std::span(inputs).subspan(play.hostile));
        step_frame(scene.world, caches, scene.tuning, {dt_s, inputs}, stats);
        grabs += stats.grabs_gripped;
        fastest_player = std::max(fastest_player, fastest_player_mps(scene.world));
        fastest_body = std::max(fastest_body, fastest_body_mps(scene.world));
        ASSERT_TRUE(is_finite_world(scene.world)) << "frame " << frame;
        if (frame % 500 != 499) {
            continue;
        }
        place_scene(scene, caches);
        for (std::size_t i = 0; i < players.size(); ++i) {
            const Vec3 head_ws = scene.world.render_pose.at(players[i].player).head_center_ws;
            const std::uint64_t himself = scene.world.persistent_id.at(players[i].player).value;
            if (play.enclosed || i >= play.hostile) {
                ASSERT_TRUE(caches.collision.closest_point(head_ws, 30.0, {&himself, 1}))
                    << "lost: player " << i << ", frame " << frame;
            }
        }
    }
    std::printf(
        "%s: %llu frames, %zu hostile, %zu climbers, %llu grips; fastest player %.2f m/s, "
        "thing %.2f m/s\n",
        play.scene, static_cast<unsigned long long>(frames), play.hostile, play.climbers,
        static_cast<unsigned long long>(grabs), fastest_player, fastest_body);
    EXPECT_GT(grabs, frames / 100);
    EXPECT_LE(fastest_player, 20.0);
    EXPECT_LE(fastest_body, 100.0);
}

INSTANTIATE_TEST_SUITE_P(Scenes, HostilePlay,
                         testing::Values(PlayCase{"crowd", 4, 4, 8000, true},
                                         PlayCase{"station", 4, 4, 6000, true},
                                         PlayCase{"ship", 2, 3, 6000, false}),
                         [](const auto& test) { return std::string(test.param.scene); });

}  // namespace
}  // namespace handhold

// Hostile players among climbers in whole scenes, with frames of 1 to 100 ms. Long run:
// HANDHOLD_RANDOM_PLAY_FRAMES (of each scene), HANDHOLD_RANDOM_PLAY_SEED.
#include <algorithm>
#include <cstdlib>
#include <string>

#include <gtest/gtest.h>

#include "game/climber/crowd.hpp"
#include "game/levels/built_in_scenes.hpp"
#include "tests/game/run/hostile_player.hpp"
#include "tests/game/scene/finite_world.hpp"

namespace handhold::random_play_test {
namespace {

std::uint64_t number_from_environment(const char* name, std::uint64_t otherwise) {
    const char* const text = std::getenv(name);
    return text != nullptr ? std::strtoull(text, nullptr, 10) : otherwise;
}

constexpr double k_shortest_frame_s = 0.001;

struct PlayCase {
    const char* scene;
    std::size_t hostile;
    std::size_t climbers;
    std::uint64_t frames;
    bool pulls = false;  // distance grab is on
    std::uint64_t frames_a_grip =
        100;  // at most this many frames for each grip, or the scene was not played in
    std::uint64_t seed = 1;
};

constexpr double k_far_jump_m = 5000.0;
constexpr double k_pull_reach_m = 6.0;  // across a module: hands point anywhere
// Of a head in a frame: three jumps of two metres, and the motion of its hands and a ship.
constexpr double k_farthest_step_m = 15.0;

class HostilePlay : public testing::TestWithParam<PlayCase> {};

// Largest speed of any player relative to the scene's own velocity.
double fastest_player_mps(const World& world) {
    double fastest = 0.0;
    for (const PlayerVelocity& velocity : world.player_velocity.elements()) {
        fastest = std::max(fastest, (velocity.linear_mps - world.reference_velocity_mps).norm());
    }
    return fastest;
}
// A body in a hand is as fast as a hand that jumps; only bodies that fly freely count.
double fastest_loose_mps(const World& world) {
    double fastest = 0.0;
    for (std::size_t index = 0; index < world.body.size(); ++index) {
        const Entity body = world.body.owners()[index];
        const bool held = std::ranges::any_of(
            world.grab.elements(), [body](const Grab& grab) { return grab.body == body; });
        if (world.body.elements()[index].kind == BodyKind::free && !held) {
            const Vec3& velocity = world.body_velocity.at(body).linear_mps;
            fastest = std::max(fastest, (velocity - world.reference_velocity_mps).norm());
        }
    }
    return fastest;
}

// A scene, its players, and what was observed.
struct Playground {
    const PlayCase& play;
    Scene scene;
    std::vector<hh::Player> players;
    double fastest_player = 0.0;
    double fastest_loose = 0.0;
    double farthest_step_m = 0.0;     // of a head
    std::vector<Vec3> last_heads_ws;  // by player
    std::uint64_t grabs = 0;
    std::uint64_t pulled_frames = 0;  // frames times hands that pull

    Playground(const PlayCase& in, std::uint64_t seed)
        : play(in), scene(*make_built_in_scene(in.scene)) {
        scene.tuning().locomotion.thruster_mps2 = 0.5;
        if (in.pulls) {
            scene.tuning().pull.reach_m = k_pull_reach_m;
        }
        const hh::Pose first_ws = scene.spawns.front().pose_ws;
        for (const hh::Pose& origin_ws :
             spread_players(scene, first_ws, in.hostile + in.climbers, seed)) {
            const std::string name = "player" + std::to_string(players.size());
            players.push_back(add_scene_player(scene, name, origin_ws));
        }
    }
    Vec3 head_ws(std::size_t player) const {
        return scene.world().render_pose.at(entity_of(players[player])).head_center_ws;
    }
    bool is_lost(std::size_t player) {
        constexpr double k_near_m = 30.0;
        return !scene.host.closest_point(to_host(head_ws(player)), k_near_m, players[player]);
    }
    void watch(const StageStats& stats) {
        grabs += stats.grabs_gripped;
        pulled_frames += scene.world().hand_pull.size();
        fastest_player = std::max(fastest_player, fastest_player_mps(scene.world()));
        fastest_loose = std::max(fastest_loose, fastest_loose_mps(scene.world()));
        for (std::size_t i = 0; i < players.size(); ++i) {
            if (last_heads_ws.size() == players.size()) {
                farthest_step_m = std::max(farthest_step_m, (head_ws(i) - last_heads_ws[i]).norm());
            }
        }
        last_heads_ws.clear();
        for (std::size_t i = 0; i < players.size(); ++i) {
            last_heads_ws.push_back(head_ws(i));
        }
        ASSERT_TRUE(is_finite_world(scene.world())) << "frame " << scene.world().clock.frame;
        if (scene.world().clock.frame % 500 != 0) {
            return;
        }
        // A hostile player may leave through the station's open end, where there is nothing to
        // hold.
        for (std::size_t i = play.hostile; i < players.size(); ++i) {
            ASSERT_FALSE(is_lost(i)) << "player " << i << ", frame " << scene.world().clock.frame;
        }
    }
};

TEST_P(HostilePlay, StaysFiniteBoundedAndLosesNobody) {
    const PlayCase& play = GetParam();
    const std::uint64_t seed = number_from_environment("HANDHOLD_RANDOM_PLAY_SEED", play.seed);
    const std::uint64_t frames =
        number_from_environment("HANDHOLD_RANDOM_PLAY_FRAMES", play.frames);
    Playground stage(play, seed);
    hh::World& world = stage.scene.host;
    std::vector<HostilePlayer> hostile;
    for (std::size_t i = 0; i < play.hostile; ++i) {
        hostile.emplace_back(seed + i, k_far_jump_m);
    }
    Crowd crowd(world, std::span(stage.players).subspan(play.hostile), seed);
    std::vector<hh_player_input> inputs(stage.players.size());
    Random random(seed);
    for (std::uint64_t frame = 0; frame < frames; ++frame) {
        // Mostly regular frames, rarely any length from 1 to 100 ms.
        const double share = random.unit();
        const double long_s = k_shortest_frame_s + 0.099 * share * random.unit();
        const double dt_s = random.chance(0.2) ? long_s : 1.0 / 90.0;
        const double start_s = world.time_s();
        for (std::size_t i = 0; i < play.hostile; ++i) {
            inputs[i] = hostile[i].play(stage.players[i], start_s, start_s + dt_s);
        }
        crowd.drive(sight_of(stage.scene), start_s + dt_s, std::span(inputs).subspan(play.hostile));
        ASSERT_TRUE(world.step(dt_s, inputs)) << hh_last_error();
        ASSERT_NO_FATAL_FAILURE(stage.watch(stage.scene.stats()));
    }
    std::printf(
        "%s: %llu frames, %zu hostile, %zu climbers, %llu grips; fastest player %.2f m/s, "
        "loose body %.2f m/s, farthest step %.2f m\n",
        play.scene, static_cast<unsigned long long>(frames), play.hostile, play.climbers,
        static_cast<unsigned long long>(stage.grabs), stage.fastest_player, stage.fastest_loose,
        stage.farthest_step_m);
    EXPECT_LE(stage.farthest_step_m, k_farthest_step_m);
    // In open space all drift out of reach in time: later parts of long runs grip nothing.
    const bool is_open = play.climbers == 0;
    EXPECT_GT(stage.grabs, (is_open ? std::min(frames, play.frames) : frames) / play.frames_a_grip);
    EXPECT_EQ(stage.pulled_frames > 0, play.pulls);
    // Twice the release speed: two players may push each other further.
    EXPECT_LE(stage.fastest_player, 2.0 * stage.scene.tuning().locomotion.release_speed_max_mps);
    EXPECT_LE(stage.fastest_loose, 2.0 * stage.scene.tuning().locomotion.object_speed_max_mps);
}

INSTANTIATE_TEST_SUITE_P(Scenes, HostilePlay,
                         testing::Values(PlayCase{"crowd", 3, 4, 1000},
                                         PlayCase{"station", 4, 4, 9000},
                                         PlayCase{"ship", 2, 3, 10000},
                                         // Open space: seeds 1 to 8 grip 3 to 111 times. All but
                                         // seed 1 pull.
                                         PlayCase{"reach", 3, 0, 6000, true, 600, 3},
                                         PlayCase{"station", 4, 2, 4000, true}),
                         [](const auto& test) {
                             return std::string(test.param.scene) +
                                    (test.param.pulls ? "_with_distance_grab" : "");
                         });

}  // namespace
}  // namespace handhold::random_play_test

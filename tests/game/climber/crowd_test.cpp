// Many climbers in one world: starting places, that none is lost, and equal results for any number
// of threads. Long run: HANDHOLD_CROWD_PLAYERS, HANDHOLD_CROWD_SECONDS, HANDHOLD_CROWD_SEED.
#include "game/climber/crowd.hpp"

#include <cstdlib>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

#include "components/fields.hpp"
#include "engine/core/parallel.hpp"
#include "game/levels/built_in_scenes.hpp"
#include "game/report/run_summary.hpp"
#include "game/run/session_run.hpp"
#include "game/scene/place_scene.hpp"
#include "tests/game/scene/finite_world.hpp"

namespace handhold::crowd_test {
namespace {

double number_from_environment(const char* name, double otherwise) {
    const char* const text = std::getenv(name);
    return text != nullptr ? std::atof(text) : otherwise;
}

std::vector<PlayerEntities> add_climbers(Scene& scene, FrameCaches& caches, std::size_t count,
                                         std::uint64_t seed) {
    constexpr double k_jets_mps2 = 0.5;
    scene.tuning.locomotion.thruster_mps2 = k_jets_mps2;
    std::vector<PlayerEntities> players;
    for (const Pose& origin_ws :
         spread_players(scene, caches, scene.spawns.front().pose_ws, count, seed)) {
        const std::string name = "player" + std::to_string(players.size());
        players.push_back(add_scene_player(scene, {name, origin_ws, 80.0}));
    }
    return players;
}

TEST(SpreadPlayers, LeavesEveryHeadClearOfSurfacesAndOfEachOther) {
    for (const char* const name : {"station", "ship"}) {
        const Scene scene = *make_built_in_scene(name);
        FrameCaches caches(*scene.shapes, scene.grip_meshes.get());
        const std::vector<Pose> places =
            spread_players(scene, caches, scene.spawns.front().pose_ws, 60, 3);
        ASSERT_EQ(places.size(), 60U) << name;
        for (std::size_t i = 1; i < places.size(); ++i) {
            EXPECT_FALSE(caches.collision.closest_point(head_over(places[i]), 0.299)) << name << i;
            for (std::size_t j = 0; j < i; ++j) {
                EXPECT_GE((head_over(places[i]) - head_over(places[j])).norm(), 0.299);
            }
        }
        const std::vector<Pose> again =
            spread_players(scene, caches, scene.spawns.front().pose_ws, 60, 3);
        for (std::size_t i = 0; i < places.size(); ++i) {
            EXPECT_EQ(places[i].position, again[i].position);
        }
    }
}

TEST(SpreadPlayers, GivesFewerIfThereIsNoSpace) {
    Scene scene;
    scene.name = "cell";
    scene.head_shape = scene.shapes->add_sphere(scene.tuning.head.radius_m);
    BodyDescription wall;
    wall.name = "inside";
    wall.shape = scene.shapes->add_box(Vec3(0.45, 0.45, 0.45));
    wall.pose_ws.position = Vec3(0.0, 1.6, 0.0);
    add_body(scene.world, wall);
    FrameCaches caches(*scene.shapes, scene.grip_meshes.get());
    EXPECT_EQ(spread_players(scene, caches, {}, 10, 1).size(), 1U);
}

TEST(CrowdThreaded, HashIsEqualForOneAndTwoThreadsAndTwiceInARow) {
    const auto hash_with = [](int threads) {
        Scene scene = *make_built_in_scene("crowd");
        const Recording recording = *make_built_in_session("crowd");
        FrameCaches caches(*scene.shapes, scene.grip_meshes.get());
        const std::vector<PlayerEntities> players = add_climbers(scene, caches, 13, 5);
        RunSettings settings{90.0, 4.0, threads};
        settings.climbers_from = 1;
        return run_session(scene, caches, players, &recording, settings).state_hash;
    };
    const std::uint64_t once = hash_with(1);
    EXPECT_EQ(hash_with(1), once);
    EXPECT_EQ(hash_with(2), once);
    set_thread_count(1);
}

// The collision world is a cache: climbers act the same with a new one.
TEST(Crowd, ContinuesEquallyFromACopyOfWorldAndStates) {
    Scene scene = *make_built_in_scene("crowd");
    FrameCaches caches(*scene.shapes, scene.grip_meshes.get());
    const std::vector<PlayerEntities> players = add_climbers(scene, caches, 8, 2);
    Crowd crowd(scene, players, 2);
    std::vector<PlayerInput> inputs(players.size());
    const auto run = [&](FrameCaches& with, int frames) {
        StageStats stats;
        for (int i = 0; i < frames; ++i) {
            const double dt_s = 1.0 / 90.0;
            crowd.drive(scene, with, scene.world.clock.t_s + dt_s, inputs);
            step_frame(scene.world, with, scene.tuning, {dt_s, inputs}, stats);
        }
        return hash_state(scene.world);
    };
    run(caches, 300);
    const World world = scene.world;
    const std::vector<ClimberState> minds = crowd.states();
    const std::uint64_t once = run(caches, 200);
    scene.world = world;
    crowd.states() = minds;
    FrameCaches fresh(*scene.shapes, scene.grip_meshes.get());
    EXPECT_EQ(run(fresh, 200), once);
}

double resident_mb() {
    std::ifstream statm("/proc/self/statm");
    double pages = 0.0;
    statm >> pages >> pages;
    return pages * static_cast<double>(sysconf(_SC_PAGESIZE)) / (1024.0 * 1024.0);
}

TEST(Crowd, StaysFiniteAndNearTheStation) {
    const auto count =
        static_cast<std::size_t>(number_from_environment("HANDHOLD_CROWD_PLAYERS", 30.0));
    const double seconds = number_from_environment("HANDHOLD_CROWD_SECONDS", 20.0);
    const auto seed =
        static_cast<std::uint64_t>(number_from_environment("HANDHOLD_CROWD_SEED", 1.0));
    Scene scene = *make_built_in_scene("station");
    FrameCaches caches(*scene.shapes, scene.grip_meshes.get());
    const std::vector<PlayerEntities> players = add_climbers(scene, caches, count, seed);
    ASSERT_EQ(players.size(), count);
    RunSettings settings{90.0, seconds, 1};
    settings.seed = seed;
    settings.climbers_from = 0;
    settings.keep_frames = false;
    RunTally tally;
    std::uint64_t jams = 0;  // frames with a contact deeper than a millimetre
    FrameCaches eyes(*scene.shapes, scene.grip_meshes.get());
    const RunLog log = run_session(
        scene, caches, players, nullptr, settings, [&](const Scene& now, const FrameLog& frame) {
            tally.add(frame);
            jams += frame.stats.residual_m > 1e-3 ? 1U : 0U;
            ASSERT_TRUE(is_finite_world(now.world)) << frame.frame;
            if (frame.frame % 5400 == 0) {
                std::printf("%5.0f s: %.1f MB resident\n", frame.t_s, resident_mb());
                std::fflush(stdout);
            }
            if (frame.frame % 450 != 0) {
                return;
            }
            place_scene(now, eyes);
            for (std::size_t i = 0; i < players.size(); ++i) {
                const std::uint64_t himself = now.world.persistent_id.at(players[i].player).value;
                EXPECT_TRUE(eyes.collision.closest_point(
                    now.world.render_pose.at(players[i].player).head_center_ws, 30.0,
                    {&himself, 1}))
                    << "lost: " << i;
            }
        });
    const RunSummary summary = tally.finish(log);
    // One in a hundred may meet another hand's holder or a head on the way.
    EXPECT_GE(summary.totals.grabs_gripped * 100, summary.totals.grab_onsets * 99);
    // A tool between two heads and a rack cannot be freed.
    EXPECT_LE(jams * 1000, summary.frames);
    for (const PlayerFigures& player : summary.players) {
        EXPECT_GE(player.path_m, 0.05 * seconds) << player.name;
    }
    std::printf(
        "%zu climbers, %.0f s: frame median %.0f us, p99 %.0f us, max %.0f us; %zu bytes "
        "of state each; %llu of %llu grabs; overlap %.2f mm, %llu frames above 1 mm\n",
        count, seconds, summary.frame.median_us, summary.frame.p99_us, summary.frame.max_us,
        log.bytes_per_player, static_cast<unsigned long long>(summary.totals.grabs_gripped),
        static_cast<unsigned long long>(summary.totals.grab_onsets), 1e3 * summary.residual_m,
        static_cast<unsigned long long>(jams));
}

}  // namespace
}  // namespace handhold::crowd_test

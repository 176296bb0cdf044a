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
#include "game/report/state_size.hpp"
#include "game/run/session_run.hpp"
#include "tests/game/scene/finite_world.hpp"

namespace handhold::crowd_test {
namespace {

double number_from_environment(const char* name, double otherwise) {
    const char* const text = std::getenv(name);
    return text != nullptr ? std::atof(text) : otherwise;
}

std::vector<hh::Player> add_climbers(Scene& scene, std::size_t count, std::uint64_t seed) {
    constexpr double k_jets_mps2 = 0.5;
    scene.tuning().locomotion.thruster_mps2 = k_jets_mps2;
    std::vector<hh::Player> players;
    for (const hh::Pose& origin_ws :
         spread_players(scene, scene.spawns.front().pose_ws, count, seed)) {
        const std::string name = "player" + std::to_string(players.size());
        players.push_back(add_scene_player(scene, name, origin_ws));
    }
    return players;
}

TEST(SpreadPlayers, LeavesEveryHeadClearOfSurfacesAndOfEachOther) {
    for (const char* const name : {"station", "ship"}) {
        Scene scene = *make_built_in_scene(name);
        const std::vector<hh::Pose> places =
            spread_players(scene, scene.spawns.front().pose_ws, 60, 3);
        ASSERT_EQ(places.size(), 60U) << name;
        for (std::size_t i = 1; i < places.size(); ++i) {
            EXPECT_FALSE(scene.host.closest_point(head_over(places[i]), 0.299)) << name << i;
            for (std::size_t j = 0; j < i; ++j) {
                EXPECT_GE(hh::length(head_over(places[i]) - head_over(places[j])), 0.299);
            }
        }
        const std::vector<hh::Pose> again =
            spread_players(scene, scene.spawns.front().pose_ws, 60, 3);
        for (std::size_t i = 0; i < places.size(); ++i) {
            EXPECT_TRUE(places[i].position == again[i].position);
        }
    }
}

TEST(SpreadPlayers, GivesFewerIfThereIsNoSpace) {
    Scene scene;
    scene.name = "cell";
    BodyDescription wall;
    wall.name = "inside";
    wall.shape = scene.shapes().add_box(Vec3(0.45, 0.45, 0.45));
    wall.pose_ws.position = Vec3(0.0, 1.6, 0.0);
    add_body(scene.world(), wall);
    EXPECT_EQ(spread_players(scene, hh::k_origin, 10, 1).size(), 1U);
}

TEST(CrowdThreaded, HashIsEqualForOneAndTwoThreadsAndTwiceInARow) {
    const auto hash_with = [](int threads) {
        Scene scene = *make_built_in_scene("crowd");
        const Recording recording = *make_built_in_session("crowd");
        const std::vector<hh::Player> players = add_climbers(scene, 13, 5);
        RunSettings settings{90.0, 4.0, threads};
        settings.climbers_from = 1;
        return run_session(scene, players, &recording, settings).state_hash;
    };
    const std::uint64_t once = hash_with(1);
    EXPECT_EQ(hash_with(1), once);
    EXPECT_EQ(hash_with(2), once);
    set_thread_count(1);
}

// Stages process up to 64 players or hands a slice: this crowd has more.
TEST(CrowdThreaded, HashIsEqualForSeveralSlicesOfEveryPlayerStage) {
    const auto hash_with = [](int threads) {
        constexpr std::size_t k_players = 66;
        Scene scene = *make_built_in_scene("station");
        const std::vector<hh::Player> players = add_climbers(scene, k_players, 5);
        EXPECT_EQ(players.size(), k_players);
        RunSettings settings{90.0, 0.4, threads};
        settings.climbers_from = 0;
        return run_session(scene, players, nullptr, settings).state_hash;  // of shown columns too
    };
    const std::uint64_t once = hash_with(1);
    EXPECT_EQ(hash_with(2), once);
    EXPECT_EQ(hash_with(4), once);
    set_thread_count(1);
}

// Climbers act the same after a restore of their world.
TEST(Crowd, ContinuesEquallyAfterARestore) {
    Scene scene = *make_built_in_scene("crowd");
    const std::vector<hh::Player> players = add_climbers(scene, 8, 2);
    Crowd crowd(scene.host, players, 2);
    std::vector<hh_player_input> inputs(players.size());
    const auto run = [&](int frames) {
        for (int i = 0; i < frames; ++i) {
            const double dt_s = 1.0 / 90.0;
            crowd.drive(sight_of(scene), scene.host.time_s() + dt_s, inputs);
            EXPECT_TRUE(scene.host.step(dt_s, inputs));
        }
        return scene.host.hash();
    };
    run(300);
    std::vector<std::byte> world;
    ASSERT_TRUE(scene.host.save(world));
    const std::vector<ClimberState> minds = crowd.states();
    const std::uint64_t once = run(200);
    ASSERT_TRUE(scene.host.restore(world));
    crowd.states() = minds;
    EXPECT_EQ(run(200), once);
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
    const std::vector<hh::Player> players = add_climbers(scene, count, seed);
    ASSERT_EQ(players.size(), count);
    RunSettings settings{90.0, seconds, 1};
    settings.seed = seed;
    settings.climbers_from = 0;
    settings.keep_frames = false;
    RunTally tally;
    std::uint64_t jams = 0;  // frames with a contact deeper than a millimetre
    const RunLog log = run_session(
        scene, players, nullptr, settings, [&](const Scene& now, const FrameLog& frame) {
            tally.add(frame);
            jams += frame.stats.residual_m > 1e-3 ? 1U : 0U;
            ASSERT_TRUE(is_finite_world(now.world())) << frame.frame;
            if (frame.frame % 5400 == 0) {
                std::printf("%5.0f s: %.1f MB resident\n", frame.t_s, resident_mb());
                std::fflush(stdout);
            }
            if (frame.frame % 450 != 0) {
                return;
            }
            for (std::size_t i = 0; i < players.size(); ++i) {
                hh::Vec3 head{};
                ASSERT_EQ(hh_player_head(now.host.get(), players[i], &head, nullptr, nullptr),
                          HH_OK);
                EXPECT_TRUE(scene.host.closest_point(head, 30.0, players[i])) << "lost: " << i;
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
        state_bytes(scene.host, players.front()),
        static_cast<unsigned long long>(summary.totals.grabs_gripped),
        static_cast<unsigned long long>(summary.totals.grab_onsets), 1e3 * summary.residual_m,
        static_cast<unsigned long long>(jams));
}

}  // namespace
}  // namespace handhold::crowd_test

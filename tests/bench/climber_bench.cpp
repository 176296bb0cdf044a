// Cost of scripted climbers: looking, deciding and moving, without the frames between.
#include <benchmark/benchmark.h>

#ifdef HANDHOLD_BENCH_GAME

#include <vector>

#include "engine/core/profile.hpp"
#include "game/climber/crowd.hpp"
#include "game/levels/built_in_scenes.hpp"

namespace handhold::climber_bench {
namespace {

void climbers(benchmark::State& state) {
    const auto players = static_cast<std::size_t>(state.range(0));
    constexpr double k_dt_s = 1.0 / 90.0;
    constexpr int k_frames = 900;
    double climbed_s = 0.0;
    double frames = 0.0;
    for (auto _ : state) {
        Scene scene = *make_built_in_scene("station");
        std::vector<hh::Player> added;
        for (const hh::Pose& origin_ws :
             spread_players(scene, scene.spawns.front().pose_ws, players, 1)) {
            const std::string name = "player" + std::to_string(added.size());
            added.push_back(add_scene_player(scene, name, origin_ws));
        }
        Crowd crowd(scene.host, added, 1);
        std::vector<hh_player_input> inputs(added.size());
        double iteration_s = 0.0;
        for (int frame = 0; frame < k_frames; ++frame) {
            const std::int64_t begin_ns = now_ns();
            crowd.drive(sight_of(scene), scene.host.time_s() + k_dt_s, inputs);
            iteration_s += 1e-9 * static_cast<double>(now_ns() - begin_ns);
            if (!scene.host.step(k_dt_s, inputs)) {
                state.SkipWithError(hh_last_error());
                return;
            }
        }
        frames += k_frames;
        climbed_s += iteration_s;
        state.SetIterationTime(iteration_s);
    }
    state.counters["us_per_climber_and_frame"] =
        1e6 * climbed_s / (frames * static_cast<double>(players));
}

BENCHMARK(climbers)
    ->Name("climber/station_frame")
    ->Arg(1)
    ->Arg(100)
    ->Iterations(1)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace handhold::climber_bench

#endif

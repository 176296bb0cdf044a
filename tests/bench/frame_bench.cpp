// Cost of whole frames and of each stage, in a built-in session.
#include <benchmark/benchmark.h>

#ifdef HANDHOLD_BENCH_GAME

#include <algorithm>
#include <functional>
#include <numeric>
#include <string>
#include <vector>

#include "engine/core/profile.hpp"
#include "game/levels/built_in_scenes.hpp"
#include "game/run/session_run.hpp"

namespace handhold::frame_bench {
namespace {

double sum_us(const RunStats& stats) {
    return std::accumulate(stats.stage_us.begin(), stats.stage_us.end(), 0.0);
}

bool grip_with_both_hands(const FrameLog& frame) {
    return std::ranges::all_of(frame.players, [](const PlayerLog& player) {
        return std::ranges::all_of(player.hands,
                                   [](const HandLog& hand) { return hand.grip != 0; });
    });
}

// Sorts the times.
void add_percentiles(const std::string& name, std::vector<double>& times_us,
                     benchmark::State& state) {
    std::ranges::sort(times_us);
    const auto at = [&times_us](double share) {
        return times_us[static_cast<std::size_t>(share * static_cast<double>(times_us.size() - 1))];
    };
    state.counters[name + "_frames"] = static_cast<double>(times_us.size());
    if (!times_us.empty()) {
        state.counters[name + "_median_us"] = at(0.5);
        state.counters[name + "_p99_us"] = at(0.99);
    }
}

// Repeats the scene's session; measures only step_frame. Percentiles are of thread CPU time,
// independent of other load.
void run_frames(benchmark::State& state, const char* name) {
    const auto players = static_cast<std::size_t>(state.range(0));
    set_stage_clock(StageClock::thread_cpu);
    double frames = 0.0;
    RunStats sum;
    std::vector<double> all_us;
    std::vector<double> both_hands_us;
    for (auto _ : state) {
        Scene scene = *make_built_in_scene(name);
        const Recording recording = *make_built_in_session(name);
        std::vector<PlayerEntities> entities;
        for (std::size_t i = 0; i < players; ++i) {
            entities.push_back(add_scene_player(
                scene, {"player" + std::to_string(i),
                        from_host(scene.spawns[i % scene.spawns.size()].pose_ws), 80.0}));
        }
        const RunLog log = run_session(scene, player_ids(entities), &recording, {90.0, 0.0, 1});
        for (const FrameLog& frame : log.frames) {
            std::transform(frame.stats.stage_us.begin(), frame.stats.stage_us.end(),
                           sum.stage_us.begin(), sum.stage_us.begin(), std::plus<>());
            all_us.push_back(sum_us(frame.stats));
            if (grip_with_both_hands(frame)) {
                both_hands_us.push_back(all_us.back());
            }
        }
        frames += static_cast<double>(log.frames.size());
        state.SetIterationTime(log.wall_s);
    }
    state.counters["us_per_frame"] = sum_us(sum) / frames;
    add_percentiles("all", all_us, state);
    add_percentiles("both_hands", both_hands_us, state);
    state.counters["players_per_frame"] = static_cast<double>(players);
    for (std::size_t stage = 0; stage < sum.stage_us.size(); ++stage) {
        state.counters[std::string("us_") + hh_stage_name(stage)] = sum.stage_us[stage] / frames;
    }
}

void station_session(benchmark::State& state) { run_frames(state, "station"); }
void ship_session(benchmark::State& state) { run_frames(state, "ship"); }

BENCHMARK(station_session)
    ->Name("frame/station_session")
    ->Arg(1)
    ->Arg(10)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(ship_session)
    ->Name("frame/ship_session")
    ->Arg(1)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace handhold::frame_bench

#endif

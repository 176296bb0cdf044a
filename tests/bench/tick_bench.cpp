// What a match pays on a player's machine: in each frame, a return to the state of 18 ticks before
// (150 ms of round trip and 40 ms of jitter), 17 ticks that are not shown and one that is. Also
// with 24 ticks (about 100 ms one way).
#include <benchmark/benchmark.h>

#ifdef HANDHOLD_BENCH_GAME

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "engine/core/profile.hpp"
#include "game/climber/crowd.hpp"
#include "game/levels/built_in_scenes.hpp"
#include "systems/host/host_columns.hpp"
#include "systems/snapshot/simulated_state.hpp"

namespace handhold::tick_bench {
namespace {

constexpr double k_dt_s = 1.0 / 90.0;
constexpr int k_frames = 1800;

// The inputs of a tick, and copies of their samples.
struct TickInput {
    std::vector<hh_player_input> inputs;
    std::vector<std::vector<hh_tracking_sample>> samples;

    void copy(const std::vector<hh_player_input>& given) {
        inputs = given;
        samples.resize(given.size());
        for (std::size_t i = 0; i < given.size(); ++i) {
            samples[i].assign(given[i].samples, given[i].samples + given[i].sample_count);
            inputs[i].samples = samples[i].data();
        }
    }
};

class Match {
  public:
    Match(const char* name, std::size_t players, std::size_t ticks)
        : scene_(*make_built_in_scene(name)), ticks_(ticks), states_(ticks), inputs_(ticks) {
        std::vector<hh::Player> added;
        for (const hh::Pose& origin_ws :
             spread_players(scene_, scene_.spawns.front().pose_ws, players, 1)) {
            added.push_back(
                add_scene_player(scene_, "player" + std::to_string(added.size()), origin_ws));
        }
        crowd_ = std::make_unique<Crowd>(scene_.host, added, 1);
        given_.resize(players);
    }
    // The new inputs of a tick. False if the scene refuses the step.
    bool frame() {
        crowd_->drive(sight_of(scene_), scene_.host.time_s() + k_dt_s, given_);
        // The last tick of the last frame was the shown one; its state is that of this tick.
        states_[tick_ % ticks_].keep(columns().world);
        inputs_[tick_ % ticks_].copy(given_);
        ++tick_;
        const std::size_t first = tick_ - std::min(tick_, ticks_);
        double iterations = 0.0;
        const std::int64_t begin_ns = thread_cpu_now_ns();
        states_[first % ticks_].restore(columns().world);
        for (std::size_t tick = first; tick + 1 < tick_; ++tick) {
            const std::int64_t tick_ns = thread_cpu_now_ns();
            const std::vector<hh_player_input>& inputs = inputs_[tick % ticks_].inputs;
            if (!scene_.host.step_simulated(k_dt_s, inputs)) {
                return false;
            }
            tick_us.push_back(1e-3 * static_cast<double>(thread_cpu_now_ns() - tick_ns));
            iterations += newton_iterations();
        }
        const std::int64_t shown_ns = thread_cpu_now_ns();
        if (!scene_.host.step(k_dt_s, inputs_[(tick_ - 1) % ticks_].inputs)) {
            return false;
        }
        const std::int64_t end_ns = thread_cpu_now_ns();
        shown_us.push_back(1e-3 * static_cast<double>(end_ns - shown_ns));
        frame_ms.push_back(1e-6 * static_cast<double>(end_ns - begin_ns));
        frame_iterations.push_back(iterations + newton_iterations());
        for (const Grab& grab : columns().world.grab.elements()) {
            grips += grab.kind != GripKind::none ? 1.0 : 0.0;
        }
        return true;
    }

    std::vector<double> tick_us;           // ticks that are not shown
    std::vector<double> shown_us;          // the last tick of each frame
    std::vector<double> frame_ms;          // all ticks of a frame, and the return
    std::vector<double> frame_iterations;  // Newton iterations of all ticks of a frame
    double grips = 0.0;                    // hands that grip, summed over frames

  private:
    HostColumns columns() { return columns_of(scene_.host.get()); }
    double newton_iterations() const {
        const hh_world* const world = scene_.host.get();
        return static_cast<double>(columns_of(world).stats.newton_iterations);
    }

    Scene scene_;
    std::unique_ptr<Crowd> crowd_;
    std::vector<hh_player_input> given_;
    std::size_t ticks_;  // stepped in each frame
    std::vector<SimulatedState> states_;
    std::vector<TickInput> inputs_;
    std::size_t tick_ = 0;
};

// Sorts the values.
void add_percentiles(const std::string& name, std::vector<double>& values,
                     benchmark::State& state) {
    std::ranges::sort(values);
    const auto at = [&values](double share) {
        return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
    };
    state.counters[name + "_median"] = at(0.5);
    state.counters[name + "_p99"] = at(0.99);
    state.counters[name + "_worst"] = at(1.0);
}

// Thread CPU time, independent of other load; one thread.
void play(benchmark::State& state, const char* name, std::size_t ticks = 18) {
    const auto players = static_cast<std::size_t>(state.range(0));
    for (auto _ : state) {
        Match match(name, players, ticks);
        for (int frame = 0; frame < k_frames; ++frame) {
            if (!match.frame()) {
                state.SkipWithError(hh_last_error());
                return;
            }
        }
        add_percentiles("tick_us", match.tick_us, state);
        add_percentiles("shown_us", match.shown_us, state);
        add_percentiles("frame_ms", match.frame_ms, state);
        add_percentiles("frame_iterations", match.frame_iterations, state);
        state.counters["gripping_hands"] = match.grips / k_frames;
    }
}

void station(benchmark::State& state) { play(state, "station"); }
void arena(benchmark::State& state) { play(state, "arena"); }
void arena_24_ticks(benchmark::State& state) { play(state, "arena", 24); }
void playground(benchmark::State& state) { play(state, "playground"); }

BENCHMARK(station)->Name("match/station")->Arg(8)->Iterations(1)->Unit(benchmark::kMillisecond);
BENCHMARK(arena)->Name("match/arena")->Arg(8)->Iterations(1)->Unit(benchmark::kMillisecond);
BENCHMARK(arena_24_ticks)
    ->Name("match/arena_24_ticks")
    ->Arg(8)
    ->Iterations(1)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(playground)
    ->Name("match/playground")
    ->Arg(8)
    ->Iterations(1)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace handhold::tick_bench

#endif

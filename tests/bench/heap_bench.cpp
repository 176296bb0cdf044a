// A held crate pushed at 1.5 m/s into a cube of crates 5 mm apart in front of a wall: the largest
// contact islands of ordinary play.
#include <algorithm>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "engine/core/profile.hpp"
#include "tests/systems/frame/scenario.hpp"

namespace handhold::heap_bench {
namespace {

constexpr double k_half_m = 0.1;
constexpr double k_spacing_m = 2.0 * k_half_m + 0.005;

void add_heap(Scenario& s, int side) {
    const Vec3 first(0.3 - 0.5 * (side - 1) * k_spacing_m, 1.2 - 0.5 * (side - 1) * k_spacing_m,
                     -0.45);
    for (int i = 0; i < side * side * side; ++i) {
        const Vec3 place(i % side, i / side % side, -(i / (side * side)));
        s.add_crate("crate" + std::to_string(i), 5.0, first + k_spacing_m * place,
                    Vec3::Constant(k_half_m));
    }
    s.add_wall("wall", Vec3(3.0, 3.0, 0.1),
               Vec3(0.3, 1.2, -0.45 - side * k_spacing_m + k_half_m - 0.2));
}

void shove_into_heap(benchmark::State& state) {
    const auto side = static_cast<int>(state.range(0));
    std::vector<double> frame_ms;
    double iterations = 0.0;
    for (auto _ : state) {
        Scenario s;
        s.add_crate("held", 2.0, Vec3(0.3, 1.2 - k_half_m - 0.02, -0.1), Vec3::Constant(k_half_m));
        add_heap(s, side);
        s.script.grabs[1] = [](double) { return true; };
        s.script.hands[1] = [](double t_s) {
            return Pose{Vec3(0.3, 1.2, -0.02 - 0.6 * ease(t_s, 0.2, 0.6)), Quat::Identity()};
        };
        s.add_player_here();
        s.run(1.0, [&] {
            double sum_us = 0.0;
            for (const double us : s.stats.stage_us) {
                sum_us += us;
            }
            frame_ms.push_back(1e-3 * sum_us);
            iterations += static_cast<double>(s.stats.newton_iterations);
        });
    }
    std::sort(frame_ms.begin(), frame_ms.end());
    state.counters["ms_median"] = frame_ms[frame_ms.size() / 2];
    state.counters["ms_p99"] = frame_ms[frame_ms.size() * 99 / 100];
    state.counters["ms_worst"] = frame_ms.back();
    state.counters["newton_iterations"] = iterations / static_cast<double>(frame_ms.size());
}

BENCHMARK(shove_into_heap)->Name("frame/heap")->DenseRange(2, 4)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace handhold::heap_bench

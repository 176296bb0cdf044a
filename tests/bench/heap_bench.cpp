// A held crate pushed at 1.5 m/s into a cube of crates 5 mm apart in front of a wall: the largest
// contact islands of ordinary play.
#include <algorithm>
#include <vector>

#include <benchmark/benchmark.h>

#include "engine/core/profile.hpp"
#include "tests/systems/frame/shoved_heap.hpp"

namespace handhold::heap_bench {
namespace {

void shove_into_heap(benchmark::State& state) {
    const auto side = static_cast<int>(state.range(0));
    std::vector<double> frame_ms;
    double iterations = 0.0;
    for (auto _ : state) {
        Scenario s;
        test::add_shoved_heap(side, s);
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

// Cost of a rollback without its frames: saving into reused memory, restoring, and the state hash.
#include <benchmark/benchmark.h>

#ifdef HANDHOLD_BENCH_GAME

#include "game/levels/built_in_scenes.hpp"
#include "systems/frame/frame.hpp"
#include "systems/snapshot/snapshot.hpp"

namespace handhold::snapshot_bench {
namespace {

Scene station_with(std::int64_t players) {
    Scene scene = *make_built_in_scene("station");
    for (std::int64_t i = 0; i < players; ++i) {
        add_scene_player(
            scene, {"player" + std::to_string(i), from_host(scene.spawns.front().pose_ws), 80.0});
    }
    return scene;
}

void save(benchmark::State& state) {
    const Scene scene = station_with(state.range(0));
    const SnapshotAssets assets(scene.shapes(), scene.name);
    std::vector<std::byte> bytes;
    for (auto _ : state) {
        save_snapshot(scene.world(), assets, bytes);
    }
    state.counters["bytes"] = static_cast<double>(bytes.size());
}

void restore(benchmark::State& state) {
    const Scene scene = station_with(state.range(0));
    const SnapshotAssets assets(scene.shapes(), scene.name);
    std::vector<std::byte> bytes;
    save_snapshot(scene.world(), assets, bytes);
    World world;
    for (auto _ : state) {
        if (restore_snapshot(bytes, assets, world)) {
            state.SkipWithError("refused");
        }
    }
}

void hash(benchmark::State& state) {
    const Scene scene = station_with(state.range(0));
    for (auto _ : state) {
        benchmark::DoNotOptimize(hash_state(scene.world()));
    }
}

BENCHMARK(save)->Name("snapshot/save")->Arg(1)->Arg(100);
BENCHMARK(restore)->Name("snapshot/restore")->Arg(1)->Arg(100);
BENCHMARK(hash)->Name("snapshot/hash")->Arg(1)->Arg(100);

}  // namespace
}  // namespace handhold::snapshot_bench

#endif

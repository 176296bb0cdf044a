// Adding, finding and destroying many entities.
#include <string>

#include <benchmark/benchmark.h>

#include "components/world.hpp"
#include "systems/frame/frame.hpp"

namespace handhold {
namespace {

void add_rocks(int count, ShapeId shape, World& world) {
    for (int i = 0; i < count; ++i) {
        const std::string name = "rock" + std::to_string(i);
        BodyDescription rock;
        rock.name = name;
        rock.body = {BodyKind::free, 1.0, Vec3::Constant(0.01), 0.0, 0.4};
        rock.pose_ws.position = Vec3(i % 100, (i / 100) % 100, i / 10000);
        rock.shape = shape;
        add_body(world, rock);
    }
}

void add_bodies(benchmark::State& state) {
    for (auto _ : state) {
        World world;
        add_rocks(static_cast<int>(state.range(0)), k_no_shape, world);
        benchmark::DoNotOptimize(world.body.size());
    }
    state.SetComplexityN(state.range(0));
}
BENCHMARK(add_bodies)
    ->Name("world/add_bodies")
    ->RangeMultiplier(10)
    ->Range(1000, 100000)
    ->Unit(benchmark::kMillisecond)
    ->Complexity();

// The frame after all bodies but a few were destroyed.
void destroy_bodies(benchmark::State& state) {
    ShapeLibrary shapes;
    const ShapeId ball = shapes.add_sphere(0.1);
    for (auto _ : state) {
        state.PauseTiming();
        World world;
        add_rocks(static_cast<int>(state.range(0)), ball, world);
        FrameCaches caches(shapes);
        StageStats stats;
        step_frame(world, caches, {}, {}, stats);
        state.ResumeTiming();
        while (world.body.size() > 3) {
            destroy(world, world.body.owners()[0]);
        }
        step_frame(world, caches, {}, {}, stats);
    }
    state.SetComplexityN(state.range(0));
}
BENCHMARK(destroy_bodies)
    ->Name("world/destroy_bodies_and_step")
    ->RangeMultiplier(10)
    ->Range(1000, 10000)
    ->Unit(benchmark::kMillisecond)
    ->Complexity();

// A frame in which all bodies rest, far from each other: fixed or free.
void step_at_rest(benchmark::State& state, BodyKind kind) {
    ShapeLibrary shapes;
    World world;
    add_rocks(static_cast<int>(state.range(0)), shapes.add_sphere(0.1), world);
    for (RigidBody& body : world.body.elements()) {
        body.kind = kind;
    }
    FrameCaches caches(shapes);
    StageStats stats;
    constexpr int k_warm_frames = 3;
    for (int frame = 0; frame < k_warm_frames; ++frame) {
        step_frame(world, caches, {}, {}, stats);
    }
    for (auto _ : state) {
        step_frame(world, caches, {}, {}, stats);
    }
    state.counters["active_bodies"] = static_cast<double>(stats.active_bodies);
    state.counters["bounds_updates"] = static_cast<double>(stats.bounds_updates);
}
void step_fixed(benchmark::State& state) { step_at_rest(state, BodyKind::fixed); }
void step_still(benchmark::State& state) { step_at_rest(state, BodyKind::free); }
BENCHMARK(step_fixed)->Name("world/step_fixed")->Arg(20000)->Unit(benchmark::kMillisecond);
BENCHMARK(step_still)->Name("world/step_free_at_rest")->Arg(10000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace handhold

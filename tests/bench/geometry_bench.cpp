// Mesh operations for hands: building (per mesh; items are triangles) and queries. `detail` builds
// with both levels of detail; full: graph and tree only. Counters: triangles kept, memory.
#include <cmath>
#include <filesystem>
#include <random>

#include <benchmark/benchmark.h>

#include "engine/geometry/grip_mesh.hpp"
#include "engine/geometry/grip_mesh_cache.hpp"
#include "engine/geometry/grip_mesh_library.hpp"

#ifdef HANDHOLD_BENCH_GAME
#include "game/levels/built_in_scenes.hpp"
#endif

namespace handhold::geometry_bench {
namespace {

// A wavy sheet of 2 n^2 triangles with edges of 7 mm, as dense as a scan, with hills of 2 cm.
Mesh make_hills(std::uint32_t n) {
    constexpr double k_edge_m = 5e-3;
    Mesh mesh;
    for (std::uint32_t z = 0; z <= n; ++z) {
        for (std::uint32_t x = 0; x <= n; ++x) {
            double across = 0.0;
            double along = 0.0;
            double unused = 0.0;
            sin_cos(0.17 * x, across, unused);
            sin_cos(0.11 * z, along, unused);
            mesh.positions.emplace_back(k_edge_m * x, 0.02 * across * along, k_edge_m * z);
        }
    }
    for (std::uint32_t z = 0; z < n; ++z) {
        for (std::uint32_t x = 0; x < n; ++x) {
            const std::uint32_t corner = z * (n + 1) + x;
            mesh.triangles.push_back({corner, corner + n + 1, corner + 1});
            mesh.triangles.push_back({corner + 1, corner + n + 1, corner + n + 2});
        }
    }
    return mesh;
}

std::uint32_t side_for(std::int64_t triangles) {
    return static_cast<std::uint32_t>(std::sqrt(static_cast<double>(triangles) / 2.0));
}

class Places {
  public:
    explicit Places(const Mesh& mesh) : mesh_(mesh) {}
    Vec3 near_surface(double reach_m) {
        const auto v = random_() % mesh_.positions.size();
        return mesh_.positions[v] + reach_m * direction();
    }
    Vec3 direction() {
        const auto number = [&] { return static_cast<double>(random_() >> 11) * 0x1p-52 - 1.0; };
        const double x = number();
        const double y = number();
        return {x, y, number()};
    }

  private:
    const Mesh& mesh_;
    std::mt19937_64 random_{7};
};

void build_graph(benchmark::State& state) {
    const Mesh mesh = make_hills(side_for(state.range(0)));
    for (auto _ : state) {
        benchmark::DoNotOptimize(build_surface_graph(mesh));
    }
    state.SetItemsProcessed(static_cast<std::int64_t>(mesh.triangles.size()) * state.iterations());
}

void build_bvh(benchmark::State& state) {
    const Mesh mesh = make_hills(side_for(state.range(0)));
    std::size_t bytes = 0;
    for (auto _ : state) {
        const TriangleBvh bvh(mesh.positions, mesh.triangles);
        bytes = bvh.memory_bytes();
    }
    state.counters["MB"] = static_cast<double>(bytes) / 1e6;
    state.SetItemsProcessed(static_cast<std::int64_t>(mesh.triangles.size()) * state.iterations());
}

void count(const GripMesh& grip, benchmark::State& state) {
    state.counters["contact"] = static_cast<double>(grip.contact.triangles.size());
    state.counters["search"] = static_cast<double>(grip.search.triangles.size());
    state.counters["MB"] = static_cast<double>(memory_bytes(grip)) / 1e6;
}

void build_grip(benchmark::State& state) {
    const Mesh mesh = make_hills(side_for(state.range(0)));
    for (auto _ : state) {
        count(build_grip_mesh(mesh), state);
    }
    state.SetItemsProcessed(static_cast<std::int64_t>(mesh.triangles.size()) * state.iterations());
}

void load_grip(benchmark::State& state) {
    const Mesh mesh = make_hills(side_for(state.range(0)));
    const std::string bytes = write_grip_mesh(build_grip_mesh(mesh), grip_mesh_key(mesh, {}));
    for (auto _ : state) {  // a cached load without reading the disk
        benchmark::DoNotOptimize(read_grip_mesh(bytes, grip_mesh_key(mesh, {})));
    }
    state.counters["file_MB"] = static_cast<double>(bytes.size()) / 1e6;
}

void ask_closest(benchmark::State& state) {
    const Mesh mesh = make_hills(side_for(state.range(0)));
    const TriangleBvh bvh(mesh.positions, mesh.triangles);
    Places places(mesh);
    for (auto _ : state) {
        benchmark::DoNotOptimize(bvh.closest_point(places.near_surface(0.03), 0.15));
    }
}

void ask_ray(benchmark::State& state) {
    const Mesh mesh = make_hills(side_for(state.range(0)));
    const TriangleBvh bvh(mesh.positions, mesh.triangles);
    Places places(mesh);
    for (auto _ : state) {
        const Vec3 from = places.near_surface(0.03);
        benchmark::DoNotOptimize(bvh.cast_ray(from, from + 0.1 * places.direction()));
    }
}

void ask_sphere(benchmark::State& state) {
    const Mesh mesh = make_hills(side_for(state.range(0)));
    const TriangleBvh bvh(mesh.positions, mesh.triangles);
    Places places(mesh);
    std::int64_t found = 0;
    for (auto _ : state) {
        bvh.visit_in_sphere(places.near_surface(0.01), 0.03, [&](std::uint32_t) { ++found; });
    }
    state.SetItemsProcessed(found);
}

BENCHMARK(build_graph)
    ->Name("geometry/build_graph")
    ->Arg(100000)
    ->Arg(1000000)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(build_bvh)
    ->Name("geometry/build_bvh")
    ->Arg(100000)
    ->Arg(1000000)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(build_grip)
    ->Name("geometry/build_grip_mesh")
    ->Arg(100000)
    ->Arg(1000000)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(load_grip)
    ->Name("geometry/load_grip_mesh")
    ->Arg(100000)
    ->Arg(1000000)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(ask_closest)->Name("geometry/closest_point")->Arg(1000)->Arg(100000)->Arg(1000000);
BENCHMARK(ask_ray)->Name("geometry/cast_ray")->Arg(1000)->Arg(100000)->Arg(1000000);
BENCHMARK(ask_sphere)->Name("geometry/visit_in_sphere")->Arg(1000)->Arg(100000)->Arg(1000000);

#ifdef HANDHOLD_BENCH_GAME
void station_library(benchmark::State& state) {
    const Scene scene = *make_built_in_scene("station");
    for (auto _ : state) {
        const GripMeshLibrary library(scene.shapes());
        state.counters["shapes"] = static_cast<double>(scene.shapes().size());
        state.counters["distinct"] = static_cast<double>(library.distinct_count());
        state.counters["MB"] = static_cast<double>(library.memory_bytes()) / 1e6;
    }
}
BENCHMARK(station_library)->Name("geometry/station_library")->Unit(benchmark::kMillisecond);
#endif

}  // namespace
}  // namespace handhold::geometry_bench

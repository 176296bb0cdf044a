// Cost of iterating columns compared with plain arrays. Compare ratios within one run:
// ecs/column_elements to ecs/raw_array at most 1.05, ecs/join_three to ecs/raw_three_arrays at most
// 1.25. join_three_churned: equal orders that are no longer runs of slots, after removals and
// additions.
#include <algorithm>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "engine/ecs/column.hpp"
#include "engine/ecs/join.hpp"
#include "engine/math/math.hpp"

namespace handhold::ecs_bench {
namespace {

constexpr double k_dt_s = 1.0 / 90.0;

struct BenchMotion {
    Vec3 position_ws = Vec3::Zero();
    Vec3 velocity_ws = Vec3(1.0, 2.0, 3.0);
};
struct BenchForce {
    Vec3 force_ws_n = Vec3(0.5, 0.0, -0.5);
};
struct BenchMass {
    double inverse_mass_per_kg = 0.25;
};

void drift(BenchMotion& motion) { motion.position_ws += motion.velocity_ws * k_dt_s; }

void push(BenchMotion& motion, const BenchForce& force, const BenchMass& mass) {
    motion.velocity_ws += force.force_ws_n * (mass.inverse_mass_per_kg * k_dt_s);
    motion.position_ws += motion.velocity_ws * k_dt_s;
}

struct BenchColumns {
    Column<BenchMotion> motion;
    Column<BenchForce> force;
    Column<BenchMass> mass;
};

enum class Order { equal, churned, shuffled };

// Every seventh entity loses its element and gets a new one at the end.
template <typename T>
void churn(Column<T>& column, const std::vector<Entity>& entities) {
    for (std::size_t i = 0; i < entities.size(); i += 7) {
        column.remove(entities[i]);
        column.add(entities[i]);
    }
}

BenchColumns make_columns(std::size_t count, Order order) {
    EntityPool pool;
    std::vector<Entity> entities(count);
    std::generate(entities.begin(), entities.end(), [&] { return pool.create(); });
    BenchColumns columns;
    std::mt19937_64 random(1);
    const auto fill = [&](auto& column) {
        column.reserve(count);
        for (const Entity entity : entities) {
            column.add(entity);
        }
        if (order == Order::shuffled) {
            std::shuffle(entities.begin(), entities.end(), random);
        }
    };
    fill(columns.motion);
    fill(columns.force);
    fill(columns.mass);
    if (order == Order::churned) {
        churn(columns.motion, entities);
        churn(columns.force, entities);
        churn(columns.mass, entities);
    }
    return columns;
}

void raw_array(benchmark::State& state, std::size_t count) {
    std::vector<BenchMotion> motions(count);
    for (auto _ : state) {
        for (BenchMotion& motion : motions) {
            drift(motion);
        }
        benchmark::ClobberMemory();
    }
}

void column_elements(benchmark::State& state, std::size_t count) {
    BenchColumns columns = make_columns(count, Order::equal);
    for (auto _ : state) {
        for (BenchMotion& motion : columns.motion.elements()) {
            drift(motion);
        }
        benchmark::ClobberMemory();
    }
}

void raw_three_arrays(benchmark::State& state, std::size_t count) {
    std::vector<BenchMotion> motions(count);
    const std::vector<BenchForce> forces(count);
    const std::vector<BenchMass> masses(count);
    for (auto _ : state) {
        for (std::size_t i = 0; i < count; ++i) {
            push(motions[i], forces[i], masses[i]);
        }
        benchmark::ClobberMemory();
    }
}

void join_three(benchmark::State& state, std::size_t count, Order order) {
    BenchColumns columns = make_columns(count, order);
    for (auto _ : state) {
        join(
            columns.motion,
            [](Entity, BenchMotion& motion, const BenchForce& force, const BenchMass& mass) {
                push(motion, force, mass);
            },
            columns.force, columns.mass);
        benchmark::ClobberMemory();
    }
}

[[maybe_unused]] const bool k_registered = [] {
    const auto add = [](const char* what, std::size_t count, auto run) {
        benchmark::RegisterBenchmark(
            ("ecs/" + std::string(what) + ":" + std::to_string(count)).c_str(),
            [run, count](benchmark::State& state) {
                run(state, count);
                const auto rows = static_cast<std::int64_t>(count);
                state.SetItemsProcessed(state.iterations() * rows);
            });
    };
    for (const std::size_t count : {1024U, 16384U, 1048576U}) {
        add("raw_array", count, raw_array);
        add("column_elements", count, column_elements);
        add("raw_three_arrays", count, raw_three_arrays);
        add("join_three", count,
            [](benchmark::State& state, std::size_t n) { join_three(state, n, Order::equal); });
        add("join_three_churned", count,
            [](benchmark::State& state, std::size_t n) { join_three(state, n, Order::churned); });
        add("join_three_shuffled", count,
            [](benchmark::State& state, std::size_t n) { join_three(state, n, Order::shuffled); });
    }
    return true;
}();

}  // namespace
}  // namespace handhold::ecs_bench

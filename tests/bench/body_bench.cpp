// Cost of the bodies that follow players' heads and hands.
#include <array>
#include <cmath>
#include <cstdint>
#include <ctime>

#include <benchmark/benchmark.h>

#include "tests/systems/body/body_columns.hpp"

namespace handhold::body_bench {
namespace {

constexpr double k_dt_s = 1.0 / 90.0;

// Players who sway and turn with individual phases, both hands circling beside them.
struct Bodies : test::BodyColumns {
    double moved_s = 0.0;

    explicit Bodies(std::uint32_t count) {
        // Adds each player before its hands, as add_player does.
        for (std::uint32_t i = 0; i < count; ++i) {
            add_player(test::entity(3 * i), test::entity(3 * i + 1), test::entity(3 * i + 2));
        }
    }
    void move() {
        moved_s += k_dt_s;
        for (std::size_t i = 0; i < head.size(); ++i) {
            const double t = moved_s + 0.37 * static_cast<double>(i);
            head.elements()[i].pose_ps = {Vec3(0.05 * std::sin(t), 1.6, 0.0),
                                          rotation_about(Vec3::UnitY(), 0.6 * std::sin(0.7 * t))};
            for (std::size_t side = 0; side < k_hand_count; ++side) {
                const double out = side == 0 ? -1.0 : 1.0;
                palm.elements()[k_hand_count * i + side].pose_ws = {
                    Vec3(0.3 * out + 0.2 * std::sin(2.0 * t), 1.3 + 0.3 * std::sin(1.3 * t),
                         -0.25 + 0.2 * std::cos(2.0 * t)),
                    rotation_about(Vec3::UnitX(), 0.5 * std::sin(t))};
            }
            velocity.elements()[i].linear_mps = Vec3(std::sin(t), 0.0, 2.0 * std::cos(0.9 * t));
        }
    }
    void run() {
        estimate_arms(k_dt_s);
        pose_arms();
        propagate_spine(k_dt_s);
    }
};

double thread_s() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// Thread CPU time per frame and player, without moving the players. With one player, the clock's
// own 0.3 us would matter: see body/one_*.
template <typename Run>
void players(benchmark::State& state, Run run) {
    const std::uint32_t count = 100;
    Bodies bodies(count);
    for (int i = 0; i < 90; ++i) {
        bodies.move();
        bodies.run();
    }
    for (auto _ : state) {
        bodies.move();
        const double begin_s = thread_s();
        run(bodies);
        state.SetIterationTime((thread_s() - begin_s) / static_cast<double>(count));
    }
    benchmark::DoNotOptimize(bodies.spine_pose.elements().data());
}

BENCHMARK_CAPTURE(players, estimate, [](Bodies& b) { b.estimate_arms(k_dt_s); })
    ->Name("body/estimate_arms")
    ->UseManualTime()
    ->MinTime(0.004);
BENCHMARK_CAPTURE(players, pose, [](Bodies& b) { b.pose_arms(); })
    ->Name("body/pose_arms")
    ->UseManualTime()
    ->MinTime(0.004);
BENCHMARK_CAPTURE(players, spine, [](Bodies& b) { b.propagate_spine(k_dt_s); })
    ->Name("body/propagate_spine")
    ->UseManualTime()
    ->MinTime(0.004);
BENCHMARK_CAPTURE(players, whole, [](Bodies& b) { b.run(); })
    ->Name("body/whole")
    ->UseManualTime()
    ->MinTime(0.004);

// One player, including the cost of moving the player, which one_moving_him measures alone.
template <typename Run>
void one_player(benchmark::State& state, Run run) {
    Bodies body(1);
    for (auto _ : state) {
        body.move();
        run(body);
    }
    benchmark::DoNotOptimize(body.spine_pose.elements().data());
}

BENCHMARK_CAPTURE(one_player, nothing, [](Bodies&) {})->Name("body/one_moving_him");
BENCHMARK_CAPTURE(one_player, whole, [](Bodies& b) {
    b.run();
})->Name("body/one_moving_him_and_whole");

}  // namespace
}  // namespace handhold::body_bench

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <thread>

#include <gtest/gtest.h>

#include "engine/core/parallel.hpp"
#include "engine/math/flush_denormals.hpp"
#include "tests/engine/solver/scene.hpp"
#include "triad_steps.hpp"

// A pull at one end of a long rope fades from link to link, below the smallest normal number.
namespace handhold::solver_denormals_test {
namespace {

using test::SolverScene;

// A straight rope whose last link moves across; the others respond less and less.
SolverScene rope_pulled_across() {
    constexpr std::uint32_t k_links = 600;
    SolverScene scene;
    scene.graph.bodies = {test::fixed_body(1)};
    for (std::uint32_t i = 1; i <= k_links; ++i) {
        const Vec3 middle(0.1 * i - 0.05, 0.0, 0.0);
        scene.graph.bodies.push_back(
            test::free_body(i + 1, 1.0, Vec3(3e-4, 1e-3, 1e-3), {middle, Quat::Identity()}));
        const Vec3 point_a(i == 1 ? 0.0 : 0.05, 0.0, 0.0);
        scene.graph.blocks.push_back(
            test::row_block(RowKind::ball, i - 1, i, point_a, Vec3(-0.05, 0.0, 0.0)));
    }
    scene.graph.bodies.back().velocity_mps = Vec3(0.0, 1.0, 0.0);
    sort_blocks(scene.graph);
    build_islands(scene.graph);
    return scene;
}

std::ptrdiff_t denormal_velocities(const SolverScene& scene) {
    return std::ranges::count_if(scene.graph.bodies, [](const SolverBody& body) {
        return std::fpclassify(body.velocity_mps.y()) == FP_SUBNORMAL;
    });
}

TEST(Denormals, VelocitySolveOfALongRopeLeavesNone) {
    SolverScene scene = rope_pulled_across();
    test::solve_a_step(scene.scratch.triads, scene.view(scene.graph.islands.front()));
    EXPECT_GT(denormal_velocities(scene), 0);  // what the solver has to take care of
    scene = rope_pulled_across();
    scene.solve_velocities();
    EXPECT_EQ(denormal_velocities(scene), 0);
    EXPECT_NE(scene.body(300).velocity_mps.y(), 0.0);
}

std::ptrdiff_t denormal_heights(const SolverScene& scene) {
    return std::ranges::count_if(scene.graph.bodies, [](const SolverBody& body) {
        return std::fpclassify(body.pose_ws.position.y()) == FP_SUBNORMAL;
    });
}

// The same for positions: the last link is displaced across.
TEST(Denormals, PositionSolveOfALongRopeLeavesNone) {
    SolverScene apart = rope_pulled_across();
    apart.graph.bodies.back().pose_ws.position.y() = 1e-3;
    SolverScene scene = apart;
    test::solve_a_step(scene.scratch.triads, scene.view(scene.graph.islands.front()));
    EXPECT_GT(denormal_heights(scene), 0);  // what the solver has to take care of
    scene = apart;
    scene.solve_positions();
    EXPECT_EQ(denormal_heights(scene), 0);
    EXPECT_NE(scene.body(300).pose_ws.position.y(), 0.0);
}

// A guard around the loop over islands would cover the calling thread only.
TEST(DenormalsThreaded, SolvesOnWorkerThreadsLeaveNone) {
    using Clock = std::chrono::steady_clock;
    std::array<SolverScene, 2> velocities{rope_pulled_across(), rope_pulled_across()};
    std::array<SolverScene, 2> positions = velocities;
    std::atomic<int> present = 0;
    auto solve = [&](std::size_t i) {
        ++present;  // both islands must be solved at the same time, on two threads
        const Clock::time_point give_up = Clock::now() + std::chrono::seconds(20);
        while (present < 2 && Clock::now() < give_up) {
            std::this_thread::yield();
        }
        velocities[i].solve_velocities();
        positions[i].body(600).pose_ws.position.y() = 1e-3;
        positions[i].solve_positions();
    };
    const int before = thread_count();
    set_thread_count(2);
    parallel_for(2, solve);
    set_thread_count(before);
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(denormal_velocities(velocities[i]), 0);
        EXPECT_EQ(denormal_heights(positions[i]), 0);
        EXPECT_NE(velocities[i].body(300).velocity_mps.y(), 0.0);
    }
}

TEST(Denormals, AreFlushedDuringTheGuardsLifetime) {
#ifndef __SSE2__
    GTEST_SKIP() << "nothing is flushed on this processor";
#endif
    const volatile double tiny = 1e-300;
    const volatile double less = 1e-15;
    {
        const FlushDenormals flush;
        EXPECT_EQ(tiny * less, 0.0);
    }
    EXPECT_NE(tiny * less, 0.0);
}

}  // namespace
}  // namespace handhold::solver_denormals_test

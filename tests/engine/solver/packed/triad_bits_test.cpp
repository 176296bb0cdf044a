// Results of TriadSystem have the same bits on every processor, after any previous island, and when
// the velocity solve resumes from the position solve.
#include <bit>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "engine/solver/packed/triad_system.hpp"
#include "triad_scenes.hpp"
#include "triad_steps.hpp"

namespace handhold::solver_triad_bits_test {
namespace {

using test::Random;
using test::solve_a_step;
using test::SolverScene;
using test::triads::disturb;
using test::triads::random_island;
using test::triads::random_rope;

std::vector<std::uint64_t> bits_of(const SolverScene& scene) {
    std::vector<std::uint64_t> bits;
    const auto add = [&bits](const auto& numbers) {
        for (const double number : numbers) {
            bits.push_back(std::bit_cast<std::uint64_t>(number));
        }
    };
    for (const SolverBody& body : scene.graph.bodies) {
        add(body.pose_ws.position);
        add(body.pose_ws.rotation.coeffs());
        add(body.velocity_mps);
        add(body.spin_radps);
    }
    for (const RowBlock& block : scene.graph.blocks) {
        add(block.impulse_ws_ns);
        add(block.angular_impulse_ws_nms);
    }
    return bits;
}

TEST(TriadSystem, BitsAreEqualWithAndWithoutAvx2) {
    if (&triad_kernels() == &portable_triad_kernels()) {
        GTEST_SKIP() << "this processor has no AVX2";
    }
    for (std::uint64_t seed = 1; seed <= 100; ++seed) {
        SCOPED_TRACE(seed);
        Random random(seed);
        SolverScene fast = seed <= 50 ? random_island(random) : random_rope(random);
        disturb(fast, 0.05, random);
        SolverScene portable;
        portable.graph = fast.graph;
        TriadSystem fast_system(triad_kernels());
        TriadSystem portable_system(portable_triad_kernels());
        solve_a_step(fast_system, fast.view(fast.graph.islands.front()));
        solve_a_step(portable_system, portable.view(portable.graph.islands.front()));
        EXPECT_EQ(bits_of(fast), bits_of(portable));
    }
}

// Islands change from frame to frame; the previous ones must not affect the result.
TEST(TriadSystem, PreviousIslandsChangeNoBit) {
    TriadSystem used;
    for (int round = 0; round < 2; ++round) {
        for (std::uint64_t seed = 1; seed <= 24; ++seed) {
            SCOPED_TRACE(seed);
            Random random(seed);
            SolverScene scene = seed % 2 == 0 ? random_island(random) : random_rope(random);
            disturb(scene, 0.05, random);
            SolverScene again;
            again.graph = scene.graph;
            TriadSystem fresh;
            solve_a_step(used, scene.view(scene.graph.islands.front()));
            solve_a_step(fresh, again.view(again.graph.islands.front()));
            EXPECT_EQ(bits_of(scene), bits_of(again));
        }
    }
}

// Positions and velocities of a random island in one frame; `change` is called between the two.
template <typename Change>
void expect_same_as_reloaded(bool resumes, Change&& change) {
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
        SCOPED_TRACE(seed);
        Random random(seed);
        SolverScene scene = seed <= 50 ? random_island(random) : random_rope(random);
        disturb(scene, 0.02, random);
        const Island& island = scene.graph.islands.front();
        solve_positions(scene.view(island, BlockFilter::without_contacts), test::tight_settings(),
                        scene.scratch);
        change(scene);
        EXPECT_EQ(TriadSystem(scene.scratch.triads).resume(scene.view(island)), resumes);
        SolverScene reloaded;
        reloaded.graph = scene.graph;
        solve_island_velocities(scene.view(island), {}, scene.scratch);
        solve_island_velocities(reloaded.view(reloaded.graph.islands.front()), {},
                                reloaded.scratch);
        EXPECT_EQ(bits_of(scene), bits_of(reloaded));
    }
}

TEST(TriadSystem, ResumeGivesTheBitsOfALoad) {
    expect_same_as_reloaded(true, [](SolverScene&) {});
}

TEST(TriadSystem, ResumeIsRefusedAfterAChangeOfMassPoseOrBlock) {
    const auto first = [](SolverScene& scene) -> SolverBody& {
        return scene.body(scene.graph.bodies_of(scene.graph.islands.front()).front());
    };
    expect_same_as_reloaded(false, [&](SolverScene& scene) { first(scene).inverse_mass += 0.5; });
    expect_same_as_reloaded(false,
                            [&](SolverScene& scene) { first(scene).pose_ws.position.x() += 1e-3; });
    expect_same_as_reloaded(false, [&](SolverScene& scene) {
        scene.block(0).point_a_bs.x() += 1e-3;
        build_islands(scene.graph);
    });
}

// Islands of equal size that share a scratch, one after the other.
TEST(TriadSystem, ResumeIsRefusedForAnotherIsland) {
    SolverScene scene;
    scene.graph.bodies = {test::fixed_body(1), test::ball(2, 1.0, 0.1), test::fixed_body(3),
                          test::ball(4, 1.0, 0.1)};
    scene.graph.blocks = {test::row_block(RowKind::ball, 0, 1),
                          test::row_block(RowKind::ball, 2, 3)};
    build_islands(scene.graph);
    ASSERT_EQ(scene.graph.islands.size(), 2U);
    for (const Island& island : scene.graph.islands) {
        solve_positions(scene.view(island), test::tight_settings(), scene.scratch);
    }
    EXPECT_FALSE(scene.scratch.triads.resume(scene.view(scene.graph.islands[0])));
    EXPECT_TRUE(scene.scratch.triads.resume(scene.view(scene.graph.islands[1])));
}

}  // namespace
}  // namespace handhold::solver_triad_bits_test

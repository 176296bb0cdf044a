// Agreement of TriadSystem with RowSystem.
#include <algorithm>
#include <cstdint>
#include <optional>

#include <gtest/gtest.h>

#include "engine/solver/packed/triad_system.hpp"
#include "triad_scenes.hpp"

namespace handhold::solver_triads_test {
namespace {

using test::Random;
using test::SolverScene;
using test::triads::disturb;
using test::triads::loads;
using test::triads::move_freely;
using test::triads::random_island;
using test::triads::random_rope;

// The same equations with a limit on every ball that is never reached, so that TriadSystem does not
// take the island.
SolverScene solved_by_rows(const SolverScene& scene) {
    SolverScene rows;
    rows.graph = scene.graph;
    for (RowBlock& block : rows.graph.blocks) {
        if (block.kind == RowKind::ball) {
            block.joint.limited = true;
            block.joint.upper = 10.0;
        }
    }
    return rows;
}

// Largest difference of a body's pose between the two systems after one Newton step, metres or
// radians. None if the island has no balls, so that both use the same system.
std::optional<double> apart_after_one_step(SolverScene (*make)(Random&), std::uint64_t seed) {
    Random random(seed);
    SolverScene scene = make(random);
    disturb(scene, 0.01, random);
    SolverScene rows = solved_by_rows(scene);
    if (loads(rows)) {
        return std::nullopt;
    }
    NewtonSettings settings = test::tight_settings();
    settings.max_iterations = 1;
    scene.solve_positions(settings);
    rows.solve_positions(settings);
    double apart = 0.0;
    for (std::size_t i = 0; i < scene.graph.bodies.size(); ++i) {
        const Pose& one = scene.body(i).pose_ws;
        const Pose& other = rows.body(i).pose_ws;
        const Vec3 turn = rotation_to_vector(one.rotation * other.rotation.conjugate());
        apart = std::max({apart, (one.position - other.position).norm(), turn.norm()});
    }
    return apart;
}

// Redundant rows (a loop of balls between two bodies held still) are separated by alpha alone,
// 1e-10 of their diagonal. The condition number is its inverse, so two orders of the same sums
// differ by about eps / 1e-10 = 2e-6 of the angles, more where several loops share bodies. The
// shares guard against regressions. Of 400,000 such islands, in this solver and the one before, 1.6
// % differed by more than 1e-7, 0.06 % by more than 1e-6, two islands by more than 1e-5.
TEST(TriadSystem, OneStepAgreesWithRowSystem) {
    constexpr int k_islands = 3000;
    int compared = 0;
    int above_100_nm = 0;
    int above_1_um = 0;
    for (std::uint64_t seed = 1; seed <= k_islands; ++seed) {
        const std::optional<double> apart = apart_after_one_step(random_island, seed);
        if (!apart) {
            continue;
        }
        ++compared;
        ASSERT_LT(*apart, 1e-4) << "seed " << seed;
        above_100_nm += *apart > 1e-7 ? 1 : 0;
        above_1_um += *apart > 1e-6 ? 1 : 0;
    }
    EXPECT_GE(compared, k_islands * 9 / 10);
    EXPECT_LE(above_100_nm, k_islands * 3 / 100);
    EXPECT_LE(above_1_um, k_islands / 300);
}

// As above: bodies held still twice have redundant rows.
TEST(TriadSystem, OneStepOfRopesAgreesWithRowSystem) {
    int above_100_nm = 0;
    for (std::uint64_t seed = 1; seed <= 200; ++seed) {
        const std::optional<double> apart = apart_after_one_step(random_rope, seed);
        ASSERT_TRUE(apart);
        ASSERT_LT(*apart, 1e-5) << "seed " << seed;
        above_100_nm += *apart > 1e-7 ? 1 : 0;
    }
    EXPECT_LE(above_100_nm, 6);
}

// Whole solves. The two systems evaluate Jacobians at different iterates, so an almost stretched
// island may end elsewhere.
TEST(TriadSystem, PositionSolveEndsWhereRowSystemEnds) {
    constexpr int k_islands = 500;
    int elsewhere = 0;
    for (std::uint64_t seed = 1; seed <= k_islands; ++seed) {
        Random random(seed);
        SolverScene scene = random_island(random);
        std::ranges::for_each(scene.graph.bodies, move_freely);
        disturb(scene, 0.02, random);
        SolverScene rows = solved_by_rows(scene);
        bool agrees = scene.solve_positions().converged == rows.solve_positions().converged;
        for (std::size_t i = 0; i < scene.graph.bodies.size(); ++i) {
            const Vec3 apart = scene.body(i).pose_ws.position - rows.body(i).pose_ws.position;
            agrees = agrees && apart.norm() < 1e-5;
        }
        elsewhere += agrees ? 0 : 1;
    }
    EXPECT_LE(elsewhere, k_islands / 100);
}

void expect_velocities_as_rows_have_them(SolverScene (*make)(Random&), std::uint64_t seeds) {
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
        SCOPED_TRACE(seed);
        Random random(seed);
        SolverScene scene = make(random);
        disturb(scene, 0.0, random);
        for (RowBlock& block : scene.graph.blocks) {
            if (is_drive(block)) {
                block.drive_velocity_ws_mps = random.vector(1.0);
                block.drive_spin_ws_radps = random.vector(1.0);
            }
        }
        SolverScene rows = solved_by_rows(scene);
        scene.solve_velocities();
        rows.solve_velocities();
        double largest =
            1.0;  // grows where a drive contradicts a body held still; scale of the tolerance
        for (const RowBlock& block : rows.graph.blocks) {
            largest = std::max(
                {largest, block.impulse_ws_ns.norm(), block.angular_impulse_ws_nms.norm()});
        }
        for (std::size_t i = 0; i < scene.graph.bodies.size(); ++i) {
            const double tolerance = 1e-7 * largest;
            EXPECT_LT((scene.body(i).velocity_mps - rows.body(i).velocity_mps).norm(), tolerance);
            EXPECT_LT((scene.body(i).spin_radps - rows.body(i).spin_radps).norm(),
                      10.0 * tolerance);
        }
        // How two constraints between the same bodies share an impulse depends on regularisation.
        for (std::size_t i = 0; i < scene.graph.blocks.size(); ++i) {
            const double tolerance = 1e-3 * largest;
            EXPECT_LT((scene.block(i).impulse_ws_ns - rows.block(i).impulse_ws_ns).norm(),
                      tolerance);
            EXPECT_LT((scene.block(i).angular_impulse_ws_nms - rows.block(i).angular_impulse_ws_nms)
                          .norm(),
                      tolerance);
        }
    }
}

// About one contradictory island in thousands differs; these seeds are fixed.
TEST(TriadSystem, VelocitiesAndImpulsesAgreeWithRowSystem) {
    expect_velocities_as_rows_have_them(random_island, 500);
}
TEST(TriadSystem, VelocitiesAndImpulsesOfRopesAgreeWithRowSystem) {
    expect_velocities_as_rows_have_them(random_rope, 100);
}

}  // namespace
}  // namespace handhold::solver_triads_test

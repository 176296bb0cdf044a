#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "engine/solver/packed/triad_system.hpp"
#include "tests/engine/solver/scene.hpp"

// A long rope moves where it is pulled and is at rest elsewhere; later Newton steps skip the rows
// at rest.
namespace handhold::solver_active_rows_test {
namespace {

using test::SolverScene;

constexpr std::uint32_t k_links = 600;
constexpr double k_min_move_m = 1e-10;

enum class End { first, last };

// A zigzag rope between two fixed bodies, one of which has moved by about pull_m into the rope.
// Links fold by 0.4 rad.
SolverScene pulled_rope(End end, double pull_m = 0.02) {
    constexpr double k_along_m = 0.098;
    const double up_m = std::sqrt(0.01 - k_along_m * k_along_m);
    SolverScene scene;
    const auto joint_at = [&](std::uint32_t i) { return Vec3(k_along_m * i, i % 2 * up_m, 0.0); };
    const Vec3 moved = pull_m * Vec3(-1.0, 0.25, 0.5);
    const Vec3 none = Vec3::Zero();
    scene.graph.bodies = {
        test::fixed_body(1, {end == End::first ? Vec3(-moved) : none, Quat::Identity()})};
    for (std::uint32_t i = 0; i < k_links; ++i) {
        const Vec3 along = joint_at(i + 1) - joint_at(i);
        const Pose pose_ws{0.5 * (joint_at(i) + joint_at(i + 1)),
                           rotation_between(Vec3::UnitX(), along.normalized())};
        scene.graph.bodies.push_back(test::free_body(i + 2, 1.0, Vec3(3e-4, 1e-3, 1e-3), pose_ws));
        scene.graph.blocks.push_back(test::row_block(
            RowKind::ball, i, i + 1, Vec3(i == 0 ? 0.0 : 0.05, 0.0, 0.0), Vec3(-0.05, 0.0, 0.0)));
    }
    const Vec3 far = joint_at(k_links) + (end == End::last ? moved : none);
    scene.graph.bodies.push_back(test::fixed_body(k_links + 2, {far, Quat::Identity()}));
    scene.graph.blocks.push_back(
        test::row_block(RowKind::ball, k_links, k_links + 1, Vec3(0.05, 0.0, 0.0), none));
    sort_blocks(scene.graph);
    build_islands(scene.graph);
    return scene;
}

struct Outcome {
    int steps = 0;
    double worst_m = 0.0;
    std::size_t min_rows = 0;
};

// Newton steps on positions: on all rows, or (`restricts`) all but the first on active rows.
Outcome pull(SolverScene& scene, bool restricts, TriadSystem& system) {
    const IslandView island = scene.view(scene.graph.islands.front());
    EXPECT_TRUE(system.load(island, std::numeric_limits<double>::infinity()));
    Outcome outcome{0, 0.0, system.strand_rows()};
    for (;;) {
        system.evaluate(island);
        outcome.worst_m = system.worst_residual();
        if (outcome.worst_m < 1e-9 || outcome.steps == 20) {
            system.store_poses(island);
            return outcome;
        }
        if (restricts && outcome.steps > 0) {
            system.restrict_to_active(k_min_move_m);
        }
        outcome.min_rows = std::min(outcome.min_rows, system.active_rows());
        system.factorise({}, 1.0);
        system.solve();
        system.apply_moves(1.0);
        ++outcome.steps;
    }
}

class ActiveRows : public testing::TestWithParam<End> {};
INSTANTIATE_TEST_SUITE_P(OfARopePulledAt, ActiveRows, testing::Values(End::first, End::last),
                         [](const auto& one) {
                             return one.param == End::first ? "itsFirstEnd" : "itsLastEnd";
                         });

TEST_P(ActiveRows, AreFewAndGiveTheResultOfAllRows) {
    SolverScene whole = pulled_rope(GetParam());
    SolverScene restricted = whole;
    TriadSystem system;
    const Outcome of_whole = pull(whole, false, system);
    const Outcome of_restricted = pull(restricted, true, system);
    EXPECT_GT(of_whole.steps, 2);
    EXPECT_EQ(of_restricted.steps, of_whole.steps);
    EXPECT_LT(of_restricted.worst_m, 1e-9);
    EXPECT_EQ(of_whole.min_rows, system.strand_rows());
    EXPECT_LT(of_restricted.min_rows, system.strand_rows() * 2 / 3);
    for (std::size_t i = 0; i < whole.graph.bodies.size(); ++i) {
        const Pose& expected = whole.graph.bodies[i].pose_ws;
        const Pose& actual = restricted.graph.bodies[i].pose_ws;
        ASSERT_LT((actual.position - expected.position).norm(), 1e-9) << i;
        ASSERT_LT(actual.rotation.angularDistance(expected.rotation), 1e-7) << i;
    }
}

TEST_P(ActiveRows, BitsAreEqualWithAndWithoutAvx2) {
    SolverScene fast = pulled_rope(GetParam());
    SolverScene portable = fast;
    TriadSystem fast_system(triad_kernels());
    TriadSystem portable_system(portable_triad_kernels());
    pull(fast, true, fast_system);
    pull(portable, true, portable_system);
    for (std::size_t i = 0; i < fast.graph.bodies.size(); ++i) {
        const Pose& x = fast.graph.bodies[i].pose_ws;
        const Pose& y = portable.graph.bodies[i].pose_ws;
        for (int axis = 0; axis < 3; ++axis) {
            ASSERT_EQ(std::bit_cast<std::uint64_t>(x.position[axis]),
                      std::bit_cast<std::uint64_t>(y.position[axis]));
        }
        ASSERT_EQ(x.rotation.coeffs(), y.rotation.coeffs());
    }
}

// activate_all_rows undoes the restriction.
TEST_P(ActiveRows, AreAllRowsAfterActivation) {
    SolverScene scene = pulled_rope(GetParam());
    TriadSystem system;
    pull(scene, true, system);
    ASSERT_LT(system.active_rows(), system.strand_rows());
    system.activate_all_rows();
    EXPECT_EQ(system.active_rows(), system.strand_rows());
}

// The velocity solve resumes from the last position step, which was restricted.
TEST_P(ActiveRows, AreAllRowsAfterResume) {
    SolverScene scene = pulled_rope(GetParam());
    TriadSystem system;
    pull(scene, true, system);
    ASSERT_LT(system.active_rows(), system.strand_rows());
    ASSERT_TRUE(system.resume(scene.view(scene.graph.islands.front())));
    EXPECT_EQ(system.active_rows(), system.strand_rows());
}

// Pulled by 20 cm, the rope straightens over a hundred links, of which the first steps hardly move
// the farther ones. Restricted to the first active rows it would end some tenths of a millimetre
// short.
TEST_P(ActiveRows, GrowIfAStepDoesNotHalveTheError) {
    SolverScene scene = pulled_rope(GetParam(), -0.2);
    const NewtonResult result = scene.solve_positions();
    EXPECT_TRUE(result.converged);
    for (std::size_t i = 0; i < scene.graph.blocks.size(); ++i) {
        ASSERT_LT(scene.error_m(i), 1e-7) << i;
    }
}

// --- Reported joint errors
// -------------------------------------------------------------------------

TEST(TriadSystem, ReportedJointErrorsEqualThoseOfTheBlocks) {
    SolverScene scene = pulled_rope(End::last);
    scene.graph.blocks[100].kind = RowKind::fixed;
    scene.graph.blocks[100].rotation_a_bs = rotation_from_vector(Vec3(0.02, 0.01, -0.03));
    scene.graph.blocks[300].kind = RowKind::drive_point;
    scene.graph.blocks[300].point_a_bs += Vec3(0.3, 0.0, 0.0);  // drives do not count
    NewtonSettings settings = test::tight_settings();
    settings.max_iterations = 1;
    const NewtonResult result = scene.solve_positions(settings);
    JointError worst;
    for (const RowBlock& block : scene.graph.blocks) {
        if (is_joint(block)) {
            const JointError error = joint_error(scene.graph.bodies, block);
            worst.point_m = std::max(worst.point_m, error.point_m);
            worst.angle_rad = std::max(worst.angle_rad, error.angle_rad);
        }
    }
    ASSERT_TRUE(result.joints.has_value());
    EXPECT_GT(worst.point_m, 1e-6);
    EXPECT_GT(worst.angle_rad, 1e-6);
    EXPECT_NEAR(result.joints->point_m, worst.point_m, 1e-13);
    EXPECT_NEAR(result.joints->angle_rad, worst.angle_rad, 1e-12);
}

}  // namespace
}  // namespace handhold::solver_active_rows_test

#include "engine/solver/newton/newton.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tests/engine/solver/newton/uneven_chain.hpp"

namespace handhold::solver_newton_test {
namespace {

using test::Random;
using test::SolverScene;

constexpr double k_tolerance_m = 1e-8;  // test::tight_settings

double angle_between(const Quat& a, const Quat& b) {
    return rotation_to_vector(a * b.conjugate()).norm();
}

// A translating body drives a ball's centre to `target` in its frame.
SolverScene driven_ball(double driver_kg, double ball_kg, const Vec3& target) {
    SolverScene scene;
    scene.graph.bodies = {test::translating_body(1, driver_kg), test::ball(2, ball_kg, 0.1)};
    scene.graph.blocks = {test::row_block(RowKind::drive_point, 0, 1, target)};
    return scene;
}

// --- Positions: closed forms ---------------------------------------------------------------------

RC_GTEST_PROP(SolvePositions, PointConstraintMovesBothBodiesByTheirMassRatio,
              (std::uint64_t seed)) {
    Random random(seed);
    const double driver_kg = random.between(1.0, 200.0);
    const double ball_kg = random.between(0.1, 200.0);
    const Vec3 target = random.vector(1.0);
    SolverScene scene = driven_ball(driver_kg, ball_kg, target);
    RC_ASSERT(scene.solve_positions().converged);
    const double driver_share = ball_kg / (driver_kg + ball_kg);
    RC_ASSERT((scene.body(0).pose_ws.position + driver_share * target).norm() <
              2.0 * k_tolerance_m);
    RC_ASSERT((scene.body(1).pose_ws.position - (1.0 - driver_share) * target).norm() <
              2.0 * k_tolerance_m);
}

TEST(SolvePositions, BodyWithZeroInverseMassIsBitwiseUnchanged) {
    SolverScene scene = driven_ball(80.0, 5.0, Vec3(0.3, -0.2, 0.1));
    scene.body(0).inverse_mass = 0.0;
    EXPECT_TRUE(scene.solve_positions().converged);
    EXPECT_EQ(scene.body(0).pose_ws.position, Vec3(Vec3::Zero()));
    EXPECT_LT((scene.body(1).pose_ws.position - Vec3(0.3, -0.2, 0.1)).norm(), k_tolerance_m);
}

TEST(SolvePositions, BlockWithoutMovableBodyIsSkippedAndItsErrorReported) {
    SolverScene scene = driven_ball(80.0, 5.0, Vec3(0.3, 0.0, 0.4));
    scene.body(0).inverse_mass = 0.0;
    scene.body(1).inverse_mass = 0.0;
    scene.body(1).inverse_inertia_bs.setZero();
    const NewtonResult result = scene.solve_positions();
    EXPECT_TRUE(result.converged);
    EXPECT_EQ(result.iterations, 0);
    EXPECT_DOUBLE_EQ(scene.error_m(0), 0.5);
}

// Also from a metre and half a turn away: the welded frame ends at the drive's target.
RC_GTEST_PROP(SolvePositions, WeldConvergesFromAnyPose, (std::uint64_t seed)) {
    Random random(seed);
    SolverScene scene;
    scene.graph.bodies = {test::translating_body(1, 80.0, test::random_pose(random, 0.5)),
                          test::random_free_body(2, random)};
    scene.body(0).inverse_mass = 0.0;
    scene.body(1).pose_ws = test::random_pose(random, 0.5);
    scene.graph.blocks = {test::random_block(RowKind::drive_weld, 0, 1, random)};
    const RowBlock& weld = scene.block(0);
    const NewtonResult result = scene.solve_positions();
    RC_ASSERT(result.converged);
    const Pose target_ws = scene.body(0).pose_ws * Pose{weld.point_a_bs, weld.rotation_a_bs};
    const Pose anchor_ws = scene.body(1).pose_ws * Pose{weld.point_b_bs, weld.rotation_b_bs};
    RC_ASSERT((target_ws.position - anchor_ws.position).norm() < 2.0 * k_tolerance_m);
    RC_ASSERT(angle_between(target_ws.rotation, anchor_ws.rotation) <
              2.0 * k_tolerance_m / k_angle_lever_m);
    RC_ASSERT(scene.error_m(0) < 2.0 * k_tolerance_m);
}

// A ball of radius 0.1 above the plane y = 0, its centre driven to `target_y`.
SolverScene driven_ball_on_plane(double target_y) {
    SolverScene scene;
    scene.graph.bodies = {test::fixed_body(1), test::translating_body(2, 80.0),
                          test::ball(3, 2.0, 0.1, {Vec3(0.0, 0.15, 0.0), Quat::Identity()})};
    scene.body(1).inverse_mass = 0.0;
    scene.graph.blocks = {test::row_block(RowKind::drive_point, 1, 2, Vec3(0.0, target_y, 0.0)),
                          test::row_block(RowKind::contact, 2, 0, Vec3(0.0, -0.1, 0.0))};
    return scene;
}

TEST(SolvePositions, ReachableDriveTargetIsMetExactlyAboveAPlane) {
    SolverScene scene = driven_ball_on_plane(0.13);
    EXPECT_TRUE(scene.solve_positions().converged);
    EXPECT_NEAR(scene.body(2).pose_ws.position.y(), 0.13, k_tolerance_m);
}

// Balance of two springs: overlap / contact regularisation = drive error / drive regularisation,
// 1e-7 against the maximum of 1e-2.
TEST(SolvePositions, ContactOutweighsADriveBy1e5) {
    for (const double drive_regularisation : {1e-6, 1e-3}) {
        SolverScene scene = driven_ball_on_plane(0.0);
        NewtonSettings settings = test::tight_settings();
        settings.regularisation.drive = drive_regularisation;
        const NewtonResult result = scene.solve_positions(settings);
        EXPECT_FALSE(result.converged);
        EXPECT_NEAR(scene.error_m(1) / scene.error_m(0), 1e-5, 1e-7);
        EXPECT_NEAR(scene.body(2).pose_ws.position.y(), 0.1, 1.1e-6);
        EXPECT_NEAR(result.residual_m, 0.1, 1e-5);
    }
}

TEST(SolvePositions, FilterExcludesBlocksFromTheSolve) {
    SolverScene drives = driven_ball_on_plane(0.0);
    EXPECT_TRUE(
        drives.solve_positions(test::tight_settings(), BlockFilter::without_contacts).converged);
    EXPECT_NEAR(drives.body(2).pose_ws.position.y(), 0.0, k_tolerance_m);
    EXPECT_NEAR(drives.error_m(1), 0.1, k_tolerance_m);

    SolverScene contacts = driven_ball_on_plane(0.0);
    contacts.body(2).pose_ws.position.y() = 0.04;
    EXPECT_TRUE(
        contacts.solve_positions(test::tight_settings(), BlockFilter::without_drives).converged);
    EXPECT_NEAR(contacts.body(2).pose_ws.position.y(), 0.1, k_tolerance_m);
    EXPECT_NEAR(contacts.error_m(0), 0.1, k_tolerance_m);
}

// Two drives of one translating body towards incompatible fixed points: the body ends at the mean.
RC_GTEST_PROP(SolvePositions, ContradictingDrivesEndAtTheirMean, (std::uint64_t seed)) {
    Random random(seed);
    SolverScene scene;
    scene.graph.bodies = {test::fixed_body(1),
                          test::translating_body(2, random.between(1.0, 200.0))};
    RowBlock left = test::random_block(RowKind::drive_point, 1, 0, random);
    RowBlock right = test::random_block(RowKind::drive_point, 1, 0, random);
    right.key = 1;
    scene.graph.blocks = {left, right};
    scene.solve_positions();
    const Vec3 left_alone = left.point_b_bs - left.point_a_bs;
    const Vec3 right_alone = right.point_b_bs - right.point_a_bs;
    RC_ASSERT((scene.body(1).pose_ws.position - 0.5 * (left_alone + right_alone)).norm() < 1e-6);
    RC_ASSERT(std::abs(scene.error_m(0) - scene.error_m(1)) < 1e-6);
}

TEST(SolvePositions, DrivesOfTwoBodiesKeepTheCommonCentreOfMass) {
    // Two translating bodies drive one ball to different points. The forces balance, so the common
    // centre of mass is unchanged.
    SolverScene scene;
    scene.graph.bodies = {test::ball(1, 4.0, 0.1), test::translating_body(2, 60.0),
                          test::translating_body(3, 90.0)};
    scene.graph.blocks = {test::row_block(RowKind::drive_point, 1, 0, Vec3(0.4, 0.0, 0.0)),
                          test::row_block(RowKind::drive_point, 2, 0, Vec3(-0.1, 0.3, 0.0))};
    EXPECT_TRUE(scene.solve_positions().converged);
    Vec3 moment = Vec3::Zero();
    for (const SolverBody& body : scene.graph.bodies) {
        moment += body.mass_kg * body.pose_ws.position;
    }
    EXPECT_LT(moment.norm(), 1e-9);
}

// --- Positions: convergence ----------------------------------------------------------------------

// A rod of 1 m between two targets exactly 1 m apart, rotated away by any angle below half a turn.
TEST(SolvePositions, RodBetweenTwoDrivesConvergesFromAnyRotation) {
    for (double angle = -3.0; angle <= 3.0; angle += 0.25) {
        SolverScene scene;
        const Quat turned = rotation_about(Vec3(0.6, 0.0, 0.8), angle);
        scene.graph.bodies = {
            test::translating_body(1, 80.0),
            test::free_body(2, 1.0, Vec3(1e-4, 1.0 / 12.0, 1.0 / 12.0), {Vec3::Zero(), turned})};
        scene.body(0).inverse_mass = 0.0;
        const Vec3 end(0.5, 0.0, 0.0);
        scene.graph.blocks = {test::row_block(RowKind::drive_point, 0, 1, end, end),
                              test::row_block(RowKind::drive_point, 0, 1, -end, -end)};
        const NewtonResult result = scene.solve_positions();
        EXPECT_TRUE(result.converged) << "turned by " << angle << ", left " << result.residual_m;
    }
}

// A stretched chain of 0.1 m rods, alternately 1 and 1000 kg, whose end is driven aside by 63
// degrees. Without geometric stiffness it oscillates for all 30 iterations and leaves 47 mm.
SolverScene uneven_chain_with_a_far_drive() {
    constexpr std::uint32_t k_links = 8;
    const double length_m = 2.0 * test::k_half_link_m * k_links;
    const Vec3 target = 0.9 * length_m * Vec3(1.0, 2.0, 0.0).normalized();
    return test::uneven_chain(k_links, RowKind::drive_point, target);
}

TEST(SolvePositions, ChainWithMassRatio1000FollowsAJumpOfItsEnd) {
    const NewtonResult result = uneven_chain_with_a_far_drive().solve_positions();
    EXPECT_TRUE(result.converged) << "left " << result.residual_m;
    EXPECT_LE(result.iterations, 20);
}

TEST(SolvePositions, RegularisationOfDrivesFollowsTheSchedule) {
    NewtonSettings settings = test::tight_settings();
    settings.load_stepping_from_m = std::numeric_limits<double>::infinity();
    settings.regularisation.drive = 1e-3;
    const int usual = uneven_chain_with_a_far_drive().solve_positions(settings).iterations;
    settings.schedule.regularisation_decrease = 0.5;
    EXPECT_GT(uneven_chain_with_a_far_drive().solve_positions(settings).iterations, usual);
    // Drives that stay at the maximum regularisation are held back by the links' mass.
    settings.schedule.regularisation_decrease = 1.0;
    settings.schedule.max_drive_regularisation = settings.regularisation.drive = 1e-2;
    EXPECT_FALSE(uneven_chain_with_a_far_drive().solve_positions(settings).converged);
}

RC_GTEST_PROP(SolvePositions, NoStepExceedsTheMaximumRotation, (std::uint64_t seed)) {
    Random random(seed);
    SolverScene scene;
    scene.graph.bodies = {test::fixed_body(1, test::random_pose(random)),
                          test::random_free_body(2, random)};
    const RowKind kind =
        random.between(0.0, 1.0) < 0.5 ? RowKind::drive_point : RowKind::drive_weld;
    scene.graph.blocks = {test::random_block(kind, 0, 1, random)};
    NewtonSettings settings = test::tight_settings();
    settings.max_iterations = 1;
    settings.schedule.max_step_rotation_rad = random.between(0.05, 1.0);
    for (int i = 0; i < 5; ++i) {
        const Quat before = scene.body(1).pose_ws.rotation;
        scene.solve_positions(settings);
        RC_ASSERT(angle_between(scene.body(1).pose_ws.rotation, before) <
                  settings.schedule.max_step_rotation_rad + 1e-7);
    }
}

TEST(SolvePositions, ConvergedIslandIsBitwiseUnchanged) {
    SolverScene scene = driven_ball(80.0, 5.0, Vec3(0.3, -0.2, 0.1));
    ASSERT_TRUE(scene.solve_positions().converged);
    const Vec3 driver = scene.body(0).pose_ws.position;
    const Vec3 ball = scene.body(1).pose_ws.position;
    EXPECT_EQ(scene.solve_positions().iterations, 0);
    EXPECT_EQ(scene.body(0).pose_ws.position, driver);
    EXPECT_EQ(scene.body(1).pose_ws.position, ball);
}

// Driven 5 cm apart, as far as a drive moves in a frame.
RC_GTEST_PROP(SolvePositions, ResultIsInvariantUnderRigidMotionOfTheWorld, (std::uint64_t seed)) {
    Random random(seed);
    SolverScene here;
    here.graph.bodies = {test::random_free_body(1, random), test::random_free_body(2, random),
                         test::fixed_body(3)};
    here.graph.blocks = {test::random_block(RowKind::drive_point, 0, 1, random),
                         test::random_block(RowKind::drive_point, 1, 2, random)};
    for (RowBlock& block : here.graph.blocks) {
        test::meet(here.graph.bodies, block);
        block.point_b_bs += random.vector(0.05);
    }
    SolverScene there = here;
    const Pose moved = test::random_pose(random, 100.0);
    for (SolverBody& body : there.graph.bodies) {
        body.pose_ws = moved * body.pose_ws;
    }
    RC_ASSERT(here.solve_positions().converged);
    RC_ASSERT(there.solve_positions().converged);
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 seen = inverse_transform_point(moved, there.body(i).pose_ws.position);
        RC_ASSERT((seen - here.body(i).pose_ws.position).norm() < 1e-6);
    }
}

}  // namespace
}  // namespace handhold::solver_newton_test

#include "engine/solver/newton/newton.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tests/engine/solver/scene.hpp"

namespace handhold::solver_newton_test {
namespace {

using test::Random;
using test::SolverScene;

constexpr double k_tolerance_m = NewtonSettings{}.tolerance_m;

double angle_between(const Quat& a, const Quat& b) {
    return rotation_to_vector(a * b.conjugate()).norm();
}

// A player's hand at `hand_ps` on a body's centre.
SolverScene hand_on_ball(double player_kg, double ball_kg, const Vec3& hand_ps) {
    SolverScene scene;
    scene.graph.bodies = {test::player_body(1, player_kg), test::ball(2, ball_kg, 0.1)};
    scene.graph.blocks = {test::row_block(RowKind::drive_point, 0, 1, hand_ps)};
    return scene;
}

// --- Positions: closed forms ---------------------------------------------------------------------

RC_GTEST_PROP(SolvePositions, PointMovesBothBodiesByTheirMassRatio, (std::uint64_t seed)) {
    Random random(seed);
    const double player_kg = random.between(1.0, 200.0);
    const double ball_kg = random.between(0.1, 200.0);
    const Vec3 hand = random.vector(1.0);
    SolverScene scene = hand_on_ball(player_kg, ball_kg, hand);
    RC_ASSERT(scene.solve_positions().converged);
    const double player_share = ball_kg / (player_kg + ball_kg);
    RC_ASSERT((scene.body(0).pose_ws.position + player_share * hand).norm() < 2.0 * k_tolerance_m);
    RC_ASSERT((scene.body(1).pose_ws.position - (1.0 - player_share) * hand).norm() <
              2.0 * k_tolerance_m);
}

TEST(SolvePositions, BodyWithoutInverseMassStaysBitForBit) {
    SolverScene scene = hand_on_ball(80.0, 5.0, Vec3(0.3, -0.2, 0.1));
    scene.body(0).inverse_mass = 0.0;
    EXPECT_TRUE(scene.solve_positions().converged);
    EXPECT_EQ(scene.body(0).pose_ws.position, Vec3(Vec3::Zero()));
    EXPECT_LT((scene.body(1).pose_ws.position - Vec3(0.3, -0.2, 0.1)).norm(), k_tolerance_m);
}

TEST(SolvePositions, BlockThatNothingCanMoveIsPassedOverAndItsErrorReported) {
    SolverScene scene = hand_on_ball(80.0, 5.0, Vec3(0.3, 0.0, 0.4));
    scene.body(0).inverse_mass = 0.0;
    scene.body(1).inverse_mass = 0.0;
    scene.body(1).inverse_inertia_bs.setZero();
    const NewtonResult result = scene.solve_positions();
    EXPECT_TRUE(result.converged);
    EXPECT_EQ(result.iterations, 0);
    EXPECT_DOUBLE_EQ(scene.error_m(0), 0.5);
}

// Even where hand and body begin a metre and half a turn apart: the welded frame is where the hand
// is.
RC_GTEST_PROP(SolvePositions, WeldBringsTheBodyWhereTheHandIsFromAnyPose, (std::uint64_t seed)) {
    Random random(seed);
    SolverScene scene;
    scene.graph.bodies = {test::player_body(1, 80.0, test::random_pose(random, 0.5)),
                          test::random_free_body(2, random)};
    scene.body(0).inverse_mass = 0.0;
    scene.body(1).pose_ws = test::random_pose(random, 0.5);
    scene.graph.blocks = {test::random_block(RowKind::drive_weld, 0, 1, random)};
    const RowBlock& weld = scene.block(0);
    const NewtonResult result = scene.solve_positions();
    RC_ASSERT(result.converged);
    const Pose hand_ws = scene.body(0).pose_ws * Pose{weld.point_a_bs, weld.rotation_a_bs};
    const Pose anchor_ws = scene.body(1).pose_ws * Pose{weld.point_b_bs, weld.rotation_b_bs};
    RC_ASSERT((hand_ws.position - anchor_ws.position).norm() < 2.0 * k_tolerance_m);
    RC_ASSERT(angle_between(hand_ws.rotation, anchor_ws.rotation) <
              2.0 * k_tolerance_m / k_angle_lever_m);
    RC_ASSERT(scene.error_m(0) < 2.0 * k_tolerance_m);
}

// A ball of radius 0.1 on a plane y = 0, its centre pulled to `hand_y`.
SolverScene ball_between_hand_and_plane(double hand_y) {
    SolverScene scene;
    scene.graph.bodies = {test::fixed_body(1), test::player_body(2, 80.0),
                          test::ball(3, 2.0, 0.1, {Vec3(0.0, 0.15, 0.0), Quat::Identity()})};
    scene.body(1).inverse_mass = 0.0;
    scene.graph.blocks = {test::row_block(RowKind::drive_point, 1, 2, Vec3(0.0, hand_y, 0.0)),
                          test::row_block(RowKind::contact, 2, 0, Vec3(0.0, -0.1, 0.0))};
    return scene;
}

TEST(SolvePositions, BallInReachGoesToTheHandWithoutTouchingThePlane) {
    SolverScene scene = ball_between_hand_and_plane(0.13);
    EXPECT_TRUE(scene.solve_positions().converged);
    EXPECT_NEAR(scene.body(2).pose_ws.position.y(), 0.13, k_tolerance_m);
}

// Balance of two springs: overlap / contact regularisation = hand error / hand regularisation; 1e-7
// against its cap of 1e-2.
TEST(SolvePositions, ContactOutweighsAHandByAHundredThousand) {
    for (const double first_softness : {1e-6, 1e-3}) {
        SolverScene scene = ball_between_hand_and_plane(0.0);
        NewtonSettings settings;
        settings.regularisation.drive = first_softness;
        const NewtonResult result = scene.solve_positions(settings);
        EXPECT_FALSE(result.converged);
        EXPECT_NEAR(scene.error_m(1) / scene.error_m(0), 1e-5, 1e-7);
        EXPECT_NEAR(scene.body(2).pose_ws.position.y(), 0.1, 1.1e-6);
        EXPECT_NEAR(result.residual_m, 0.1, 1e-5);
    }
}

TEST(SolvePositions, FiltersSolveOnlyTheirOwnBlocksButReportEveryError) {
    SolverScene hands = ball_between_hand_and_plane(0.0);
    EXPECT_TRUE(hands.solve_positions({}, BlockFilter::without_contacts).converged);
    EXPECT_NEAR(hands.body(2).pose_ws.position.y(), 0.0, k_tolerance_m);
    EXPECT_NEAR(hands.error_m(1), 0.1, k_tolerance_m);

    SolverScene contacts = ball_between_hand_and_plane(0.0);
    contacts.body(2).pose_ws.position.y() = 0.04;
    EXPECT_TRUE(contacts.solve_positions({}, BlockFilter::without_drives).converged);
    EXPECT_NEAR(contacts.body(2).pose_ws.position.y(), 0.1, k_tolerance_m);
    EXPECT_NEAR(contacts.error_m(0), 0.1, k_tolerance_m);
}

// Two hands 0.5 m apart on two fixed points 0.9 m apart: the player hangs in the middle, both hands
// 0.2 m off.
RC_GTEST_PROP(SolvePositions, TwoHandsThatCannotBothBeMetEndAtTheMean, (std::uint64_t seed)) {
    Random random(seed);
    SolverScene scene;
    scene.graph.bodies = {test::fixed_body(1), test::player_body(2, random.between(1.0, 200.0))};
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

TEST(SolvePositions, HubOfHandsSharesBetweenPlayersByMass) {
    // Two players pull one ball to different points: forces balance, so the ball and both players
    // keep their common centre of mass.
    SolverScene scene;
    scene.graph.bodies = {test::ball(1, 4.0, 0.1), test::player_body(2, 60.0),
                          test::player_body(3, 90.0)};
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

// A rod of 1 m between two points that it reaches exactly, turned away by any angle short of half a
// turn.
TEST(SolvePositions, RodBetweenTwoHandsIsFoundFromAnyTurn) {
    for (double angle = -3.0; angle <= 3.0; angle += 0.25) {
        SolverScene scene;
        const Quat turned = rotation_about(Vec3(0.6, 0.0, 0.8), angle);
        scene.graph.bodies = {
            test::player_body(1, 80.0),
            test::free_body(2, 1.0, Vec3(1e-4, 1.0 / 12.0, 1.0 / 12.0), {Vec3::Zero(), turned})};
        scene.body(0).inverse_mass = 0.0;
        const Vec3 end(0.5, 0.0, 0.0);
        scene.graph.blocks = {test::row_block(RowKind::drive_point, 0, 1, end, end),
                              test::row_block(RowKind::drive_point, 0, 1, -end, -end)};
        const NewtonResult result = scene.solve_positions();
        EXPECT_TRUE(result.converged) << "turned by " << angle << ", left " << result.residual_m;
    }
}

// Rods of 0.1 m joined end to end, alternately of 1 and 1000 kg, whose stretched chain's end jumps
// aside by 63 degrees. Without geometric stiffness it zigzags for all 30 iterations and leaves 47
// mm.
SolverScene uneven_chain_with_a_far_hand() {
    constexpr std::uint32_t k_links = 8;
    constexpr double k_half_m = 0.05;
    const Vec3 end(k_half_m, 0.0, 0.0);
    SolverScene scene;
    scene.graph.bodies = {test::fixed_body(1)};
    for (std::uint32_t i = 0; i < k_links; ++i) {
        const double mass_kg = i % 2 == 0 ? 1.0 : 1000.0;
        const double across = mass_kg * k_half_m * k_half_m / 3.0;
        scene.graph.bodies.push_back(test::free_body(i + 2, mass_kg,
                                                     Vec3(0.3 * across, across, across),
                                                     {(2.0 * i + 1.0) * end, Quat::Identity()}));
        scene.graph.blocks.push_back(test::row_block(RowKind::drive_point, i, i + 1,
                                                     i == 0 ? Vec3(Vec3::Zero()) : end, -end));
    }
    scene.graph.bodies.push_back(test::player_body(k_links + 2, 80.0));
    scene.body(k_links + 1).inverse_mass = 0.0;
    const double length_m = 2.0 * k_half_m * k_links;
    const Vec3 hand = 0.9 * length_m * Vec3(1.0, 2.0, 0.0).normalized();
    scene.graph.blocks.push_back(
        test::row_block(RowKind::drive_point, k_links + 1, k_links, hand, end));
    return scene;
}

TEST(SolvePositions, ChainOfUnevenMassesFollowsAJumpOfItsEnd) {
    const NewtonResult result = uneven_chain_with_a_far_hand().solve_positions();
    EXPECT_TRUE(result.converged) << "left " << result.residual_m;
    EXPECT_LE(result.iterations, 20);
}

TEST(SolvePositions, HandsHardenAsFastAsTheScheduleSays) {
    NewtonSettings settings;
    settings.load_stepping_from_m = std::numeric_limits<double>::infinity();
    settings.regularisation.drive = 1e-3;
    const int usual = uneven_chain_with_a_far_hand().solve_positions(settings).iterations;
    settings.schedule.regularisation_decrease = 0.5;
    EXPECT_GT(uneven_chain_with_a_far_hand().solve_positions(settings).iterations, usual);
    // Hands that stay as soft as they may be are drawn off by the links' weight on the way.
    settings.schedule.regularisation_decrease = 1.0;
    settings.schedule.max_drive_regularisation = settings.regularisation.drive = 1e-2;
    EXPECT_FALSE(uneven_chain_with_a_far_hand().solve_positions(settings).converged);
}

RC_GTEST_PROP(SolvePositions, NoStepTurnsABodyFartherThanTheScheduleSays, (std::uint64_t seed)) {
    Random random(seed);
    SolverScene scene;
    scene.graph.bodies = {test::fixed_body(1, test::random_pose(random)),
                          test::random_free_body(2, random)};
    const RowKind kind =
        random.between(0.0, 1.0) < 0.5 ? RowKind::drive_point : RowKind::drive_weld;
    scene.graph.blocks = {test::random_block(kind, 0, 1, random)};
    NewtonSettings settings;
    settings.max_iterations = 1;
    settings.schedule.max_step_rotation_rad = random.between(0.05, 1.0);
    for (int i = 0; i < 5; ++i) {
        const Quat before = scene.body(1).pose_ws.rotation;
        scene.solve_positions(settings);
        RC_ASSERT(angle_between(scene.body(1).pose_ws.rotation, before) <
                  settings.schedule.max_step_rotation_rad + 1e-7);
    }
}

TEST(SolvePositions, SolvedIslandIsNotMovedByOneBit) {
    SolverScene scene = hand_on_ball(80.0, 5.0, Vec3(0.3, -0.2, 0.1));
    ASSERT_TRUE(scene.solve_positions().converged);
    const Vec3 player = scene.body(0).pose_ws.position;
    const Vec3 ball = scene.body(1).pose_ws.position;
    EXPECT_EQ(scene.solve_positions().iterations, 0);
    EXPECT_EQ(scene.body(0).pose_ws.position, player);
    EXPECT_EQ(scene.body(1).pose_ws.position, ball);
}

// Pulled 5 cm apart, as far as a hand moves in a frame.
RC_GTEST_PROP(SolvePositions, MovedAndRotatedIslandIsSolvedAlike, (std::uint64_t seed)) {
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

// The islands that TriadSystem loads and refuses, and special islands that it solves.
#include <cstdint>

#include <gtest/gtest.h>

#include "engine/solver/packed/triad_system.hpp"
#include "triad_scenes.hpp"

namespace handhold::solver_triad_load_test {
namespace {

using test::Random;
using test::SolverScene;
using test::triads::hanging_ball;
using test::triads::loads;

TEST(TriadSystem, LoadRefusesFrictionLimitsAndOtherJoints) {
    SolverScene scene = hanging_ball();
    EXPECT_TRUE(loads(scene));
    scene.block(0).joint.friction_impulse = 1.0;
    EXPECT_FALSE(loads(scene));
    scene.block(0).joint = {};
    scene.block(0).joint.limited = true;
    EXPECT_FALSE(loads(scene));
    for (const RowKind kind : {RowKind::hinge, RowKind::slider, RowKind::distance}) {
        scene.block(0) = test::row_block(kind, 0, 1);
        EXPECT_FALSE(loads(scene));
    }
}

TEST(TriadSystem, LoadIgnoresSeparatedContacts) {
    SolverScene scene = hanging_ball();
    RowBlock contact = test::row_block(RowKind::contact, 1, 0, Vec3(0.0, 0.01, 0.0));
    contact.key = 1;
    scene.graph.blocks.push_back(contact);
    sort_blocks(scene.graph);
    EXPECT_TRUE(loads(scene, 0.005));
    EXPECT_FALSE(loads(scene, 0.02));
    EXPECT_FALSE(loads(scene));  // positions may close it
}

TEST(TriadSystem, LoadRefusesHubs) {
    SolverScene scene;
    scene.graph.bodies = {test::ball(1, 5.0, 0.3)};
    for (std::uint32_t i = 1; i <= 5; ++i) {
        scene.graph.bodies.push_back(test::ball(i + 1, 1.0, 0.1));
        scene.graph.blocks.push_back(test::row_block(RowKind::ball, 0, i));
        EXPECT_EQ(loads(scene), i <= k_hub_nodes);
    }
}

// Each immovable body has its own anchor.
TEST(TriadSystem, BodyOnSeveralFixedBodiesConverges) {
    SolverScene scene;
    scene.graph.bodies = {test::fixed_body(1, {Vec3(1.0, 0.0, 0.0), Quat::Identity()}),
                          test::fixed_body(2, {Vec3(0.0, 2.0, 0.0), Quat::Identity()}),
                          test::free_body(3, 2.0, Vec3(0.1, 0.2, 0.3))};
    scene.graph.blocks = {test::row_block(RowKind::ball, 0, 2, Vec3::Zero(), Vec3(1.0, 0.0, 0.0)),
                          test::row_block(RowKind::ball, 1, 2, Vec3::Zero(), Vec3(0.0, 2.0, 0.0))};
    scene.body(2).pose_ws = {Vec3(0.02, -0.01, 0.03), rotation_from_vector(Vec3(0.1, 0.05, 0.2))};
    EXPECT_TRUE(loads(scene));
    EXPECT_TRUE(scene.solve_positions().converged);
    EXPECT_LT(scene.error_m(0), 1e-8);
    EXPECT_LT(scene.error_m(1), 1e-8);
}

// A body that belongs to the island only by an ignored contact.
TEST(TriadSystem, BodyWithoutRowsIsBitwiseUnchanged) {
    Random random(7);
    SolverScene scene = hanging_ball();
    scene.graph.bodies.push_back(test::ball(3, 1.0, 0.1, test::random_pose(random)));
    scene.body(2).pose_ws.rotation.coeffs() *= 1.0 + 1e-15;
    scene.graph.blocks.push_back(test::row_block(RowKind::contact, 2, 1));
    sort_blocks(scene.graph);
    scene.body(1).pose_ws.position.x() = 0.03;
    const Pose before = scene.body(2).pose_ws;
    EXPECT_TRUE(
        scene.solve_positions(test::tight_settings(), BlockFilter::without_contacts).converged);
    EXPECT_EQ(scene.body(2).pose_ws.position, before.position);
    EXPECT_EQ(scene.body(2).pose_ws.rotation.coeffs(), before.rotation.coeffs());
}

// Redundant rows share their impulse or get none; nothing grows without bound.
TEST(TriadSystem, RepeatedTriadsStayFinite) {
    SolverScene scene = hanging_ball();
    for (std::uint64_t i = 1; i < 4; ++i) {
        scene.graph.blocks.push_back(scene.graph.blocks.front());
        scene.graph.blocks.back().key = i;
    }
    scene.body(1).pose_ws.position = Vec3(0.03, 0.02, 0.01);
    scene.body(1).velocity_mps = Vec3(1.0, 2.0, 3.0);
    EXPECT_TRUE(loads(scene));
    EXPECT_TRUE(scene.solve_positions().converged);
    scene.solve_velocities();
    EXPECT_LT(scene.error_m(0), 1e-8);
    EXPECT_LT(scene.body(1).velocity_mps.norm(), 1e-8);
    Vec3 impulse = Vec3::Zero();
    for (const RowBlock& block : scene.graph.blocks) {
        impulse += block.impulse_ws_ns;
    }
    EXPECT_LT((impulse - Vec3(1.0, 2.0, 3.0)).norm(), 1e-8);  // on the fixed body: a
}

}  // namespace
}  // namespace handhold::solver_triad_load_test

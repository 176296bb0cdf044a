#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "tests/systems/physics/build_constraints_scene.hpp"

namespace handhold::build_constraints_test {
namespace {

using test::Building;
using test::distance;
using test::id_of;
using test::k_left;
using test::k_player;
using test::k_right;
using test::k_rock;
using test::k_wall;
using test::Random;

TEST(BuildConstraints, PlayerIsATranslatingMassWithTheHeadAsCollider) {
    Random random(1);
    Building scene;
    scene.origin.at(k_player).pose_ws = random.pose();
    scene.player_velocity.at(k_player).linear_mps = Vec3(1.0, 2.0, 3.0);
    scene.head.at(k_player).pose_ps = random.pose(1.0);
    scene.run();
    const SolverBody& player = scene.solver_body(k_player);
    EXPECT_EQ(player.role, BodyRole::translating);
    EXPECT_EQ(player.mass_kg, 70.0);
    EXPECT_EQ(player.inertia_kgm2, Vec3(Vec3::Zero()));
    EXPECT_EQ(player.velocity_mps, Vec3(1.0, 2.0, 3.0));
    EXPECT_EQ(player.restitution, scene.tuning.head.restitution);
    EXPECT_EQ(distance(player.pose_ws, scene.origin.at(k_player).pose_ws), 0.0);
    const Vec3 head = transform_point(scene.head.at(k_player).pose_ps, scene.tuning.head.center_m);
    EXPECT_LT((player.collider_offset_bs - head).norm(), 1e-15);
}

TEST(BuildConstraints, RoleOfABodyFollowsFromItsKindAndMass) {
    const double heavy_kg = PhaseTuning{}.heavy_body_kg;
    const std::vector<std::pair<RigidBody, BodyRole>> cases = {
        {{BodyKind::fixed, 0.0, Vec3::Zero(), 0.3}, BodyRole::fixed},
        {{BodyKind::kinematic, 5.0, Vec3::Ones(), 0.3}, BodyRole::fixed},
        {{BodyKind::free, 0.999 * heavy_kg, Vec3(1.0, 2.0, 3.0), 0.3}, BodyRole::free},
        {{BodyKind::free, heavy_kg, Vec3(1.0, 2.0, 3.0), 0.3}, BodyRole::heavy}};
    for (const auto& [rigid, role] : cases) {
        Building scene;
        scene.add_body(k_rock, rigid, {Vec3(1.0, 2.0, 3.0), Quat::Identity()},
                       {Vec3(4.0, 5.0, 6.0), Vec3(7.0, 8.0, 9.0)});
        scene.run();
        const SolverBody& body = scene.solver_body(k_rock);
        EXPECT_EQ(body.role, role);
        const bool free = rigid.kind == BodyKind::free;
        EXPECT_EQ(body.mass_kg, free ? rigid.mass_kg : 0.0);
        EXPECT_EQ(body.inertia_kgm2, free ? rigid.inertia_kgm2 : Vec3(Vec3::Zero()));
        EXPECT_EQ(body.restitution, 0.3);
        EXPECT_EQ(body.velocity_mps, Vec3(4.0, 5.0, 6.0));
        EXPECT_EQ(body.spin_radps, Vec3(7.0, 8.0, 9.0));
        EXPECT_EQ(body.pose_ws.position, Vec3(1.0, 2.0, 3.0));
    }
}

TEST(BuildConstraints, BodiesAreSortedByPersistentId) {
    Building scene;
    scene.add_rock(5.0);
    scene.add_body(k_wall, {});
    scene.run();
    ASSERT_EQ(scene.frame.graph.bodies.size(), 3U);
    EXPECT_EQ(scene.frame.phase.size(), 3U);
    EXPECT_TRUE(std::ranges::is_sorted(scene.frame.graph.bodies, {}, &SolverBody::id));
}

TEST(BuildConstraints, GripsBecomeRowsFromTargetToAnchor) {
    for (const GripKind kind : {GripKind::surface, GripKind::held}) {
        Random random(2);
        Building scene;
        scene.add_rock(5.0);
        scene.origin.at(k_player).pose_ws = random.pose();
        const Grab grab = scene.grip(k_right, kind, k_rock, random);
        scene.run();
        ASSERT_EQ(scene.frame.graph.blocks.size(), 1U);
        const RowBlock& block = scene.frame.graph.blocks[0];
        EXPECT_EQ(block.kind, kind == GripKind::held ? RowKind::drive_weld : RowKind::drive_point);
        EXPECT_EQ(block.a, scene.index_of_body(k_player));
        EXPECT_EQ(block.b, scene.index_of_body(k_rock));
        EXPECT_EQ(block.key, id_of(k_right));
        EXPECT_EQ(block.point_a_bs, grab.target_ps.position);
        EXPECT_EQ(block.point_b_bs, grab.anchor_bs.position);
        EXPECT_EQ(block.rotation_a_bs.coeffs(), grab.target_ps.rotation.coeffs());
        EXPECT_EQ(block.rotation_b_bs.coeffs(), grab.anchor_bs.rotation.coeffs());
        const Quat& play_space = scene.origin.at(k_player).pose_ws.rotation;
        EXPECT_LT((block.drive_velocity_ws_mps - play_space * grab.target_velocity_ps_mps).norm(),
                  1e-15);
        EXPECT_LT((block.drive_spin_ws_radps - play_space * grab.target_spin_ps_radps).norm(),
                  1e-15);
        EXPECT_EQ(scene.phase(k_player).grips_surface, kind == GripKind::surface);
        EXPECT_EQ(scene.phase(k_rock).held, kind == GripKind::held);
    }
}

TEST(BuildConstraints, LongerHoldingHandHasThePointAndTheOtherTheDirection) {
    for (const Entity first : {k_left, k_right}) {
        for (const bool two_handed : {true, false}) {
            Random random(8);
            Building scene;
            scene.add_rock(5.0);
            for (const Entity hand : {k_left, k_right}) {
                Grab& grab = scene.grip(hand, GripKind::held, k_rock, random);
                grab.since_s = hand == first ? 1.0 : 2.0;
                grab.two_handed = two_handed;
            }
            scene.run();
            const std::vector<RowBlock>& blocks = scene.frame.graph.blocks;
            ASSERT_EQ(blocks.size(),
                      two_handed ? 2U : 1U);  // too close: the first hand has all rows
            EXPECT_EQ(blocks[0].kind, two_handed ? RowKind::drive_point : RowKind::drive_weld);
            EXPECT_EQ(blocks[0].key, id_of(first));
            if (two_handed) {
                EXPECT_EQ(blocks[1].kind, RowKind::drive_direction);
            }
        }
    }
}

TEST(BuildConstraints, HandsOnAJointedBodyHaveAPointEach) {
    Random random(9);
    Building scene;
    scene.add_rock(5.0);
    for (const Entity hand : {k_left, k_right}) {
        scene.grip(hand, GripKind::held, k_rock, random).jointed = true;
    }
    scene.run();
    ASSERT_EQ(scene.frame.graph.blocks.size(), 2U);
    for (const RowBlock& block : scene.frame.graph.blocks) {
        EXPECT_EQ(block.kind, RowKind::drive_point);
    }
}

// 1/kappa is 3t^2 - 2t^3 between light and heavy: 0, 0.15625, 0.5, 1 at t = 0, 1/4, 1/2, 1.
TEST(BuildConstraints, PlayersShareFollowsTheKappaCurve) {
    const PhaseTuning phases;
    const auto mass_at = [&](double t) {
        return phases.kappa_light_kg + t * (phases.kappa_heavy_kg - phases.kappa_light_kg);
    };
    const std::vector<std::pair<double, double>> cases = {
        {1.0, 0.0},          {mass_at(0.0), 0.0}, {mass_at(0.25), 0.15625},
        {mass_at(0.5), 0.5}, {mass_at(1.0), 1.0}, {1e6, 1.0}};
    for (const auto& [mass_kg, share] : cases) {
        Random random(3);
        Building scene;
        scene.tuning.phases.heavy_body_kg = 1e9;
        scene.add_rock(mass_kg);
        scene.grip(k_left, GripKind::held, k_rock, random);
        scene.run();
        EXPECT_NEAR(scene.phase(k_player).forward_share, share, 1e-12) << mass_kg;
    }
}

TEST(BuildConstraints, HeaviestHeldBodySetsThePlayersShare) {
    for (const bool heavy_first : {false, true}) {
        Random random(4);
        Building scene;
        scene.add_rock(550.0);
        scene.add_body(k_wall, {BodyKind::free, 1.0, Vec3::Ones(), 0.0});
        scene.grip(k_left, GripKind::held, heavy_first ? k_rock : k_wall, random);
        scene.grip(k_right, GripKind::held, heavy_first ? k_wall : k_rock, random);
        scene.run();
        EXPECT_NEAR(scene.phase(k_player).forward_share, 0.5, 1e-12);
    }
}

TEST(BuildConstraints, GripOnAMissingBodyHasNoRows) {
    Random random(5);
    Building scene;
    scene.persistent_id.add(k_rock, {id_of(k_rock)});
    scene.grip(k_right, GripKind::surface, k_rock, random);
    scene.run();
    EXPECT_TRUE(scene.frame.graph.blocks.empty());
    EXPECT_FALSE(scene.phase(k_player).grips_surface);
}

TEST(BuildConstraints, ContactsBecomeRowsRelativeToTheCollidersCentre) {
    Building scene;
    scene.add_body(k_wall, {BodyKind::fixed, 0.0, Vec3::Zero(), 0.9});
    scene.head.at(k_player).pose_ps.position = Vec3(0.0, 1.6, 0.0);
    ContactPoint contact;
    contact.id_a = id_of(k_player);
    contact.id_b = id_of(k_wall);
    contact.point_a_bs = Vec3(0.0, 0.0, -0.11);
    scene.frame.contacts = {contact};
    scene.run();
    ASSERT_EQ(scene.frame.graph.blocks.size(), 1U);
    const RowBlock& block = scene.frame.graph.blocks[0];
    EXPECT_EQ(block.kind, RowKind::contact);
    const Vec3 expected = Vec3(0.0, 1.6, 0.0) + scene.tuning.head.center_m + contact.point_a_bs;
    EXPECT_LT((block.point_a_bs - expected).norm(), 1e-15);
    EXPECT_EQ(block.restitution, 0.9);
    EXPECT_EQ(scene.frame.graph.islands.size(), 1U);
}

TEST(BuildConstraints, NothingOfTheLastFrameRemains) {
    Random random(6);
    Building scene;
    scene.add_rock(550.0);
    scene.grip(k_right, GripKind::held, k_rock, random);
    scene.run();
    scene.frame.phase[scene.index_of_body(k_player)].work = 3;
    scene.grab.at(k_right) = {};
    scene.run();
    EXPECT_TRUE(scene.frame.graph.blocks.empty());
    EXPECT_TRUE(scene.frame.graph.islands.empty());
    EXPECT_EQ(scene.phase(k_player).forward_share, 0.0);
    EXPECT_EQ(scene.phase(k_player).work, 0U);
    EXPECT_FALSE(scene.phase(k_rock).held);
}

TEST(BuildConstraints, ResultDoesNotDependOnTheOrderOfHandsAndBodies) {
    Building in_order;
    Building reversed({k_right, k_left});
    in_order.add_rock(5.0);
    in_order.add_body(k_wall, {});
    reversed.add_body(k_wall, {});
    reversed.add_rock(5.0);
    for (Building* const scene : {&in_order, &reversed}) {
        Random random(7);
        scene->grip(k_left, GripKind::held, k_rock, random).two_handed = true;
        scene->grip(k_right, GripKind::held, k_rock, random).two_handed = true;
        scene->run();
    }
    ASSERT_EQ(in_order.frame.graph.blocks.size(), 2U);
    ASSERT_EQ(reversed.frame.graph.blocks.size(), 2U);
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(in_order.frame.graph.blocks[i].key, reversed.frame.graph.blocks[i].key);
        EXPECT_EQ(in_order.frame.graph.blocks[i].point_a_bs,
                  reversed.frame.graph.blocks[i].point_a_bs);
    }
    EXPECT_EQ(in_order.frame.graph.island_bodies, reversed.frame.graph.island_bodies);
}

}  // namespace
}  // namespace handhold::build_constraints_test

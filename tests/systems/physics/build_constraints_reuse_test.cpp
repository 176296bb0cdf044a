#include <gtest/gtest.h>

#include "tests/systems/physics/build_constraints_scene.hpp"

// Row blocks that build_constraints rewrites in place must equal, bit for bit, those it builds into
// an empty graph.
namespace handhold::build_constraints_reuse_test {
namespace {

using test::Building;
using test::entity;
using test::id_of;
using test::k_left;
using test::k_right;
using test::k_rock;
using test::k_wall;
using test::Random;

void expect_same(const JointRows& rows, const JointRows& expected) {
    EXPECT_EQ(rows.limited, expected.limited);
    EXPECT_EQ(rows.lower, expected.lower);
    EXPECT_EQ(rows.upper, expected.upper);
    EXPECT_EQ(rows.previous, expected.previous);
    EXPECT_EQ(rows.friction_impulse, expected.friction_impulse);
    EXPECT_EQ(rows.motor_target, expected.motor_target);
    EXPECT_EQ(rows.motor_time_s, expected.motor_time_s);
    EXPECT_EQ(rows.motor_max_impulse, expected.motor_max_impulse);
    EXPECT_EQ(rows.lock_limit_impulse, expected.lock_limit_impulse);
    EXPECT_EQ(rows.lock_impulse, expected.lock_impulse);
}

// Runs one frame over the last frame's graph, and one over an empty graph, and compares the blocks.
void expect_equal_to_rebuilt(Building& scene) {
    Building rebuilt = scene;
    rebuilt.frame.graph = {};
    scene.run();
    rebuilt.run();
    const std::vector<RowBlock>& blocks = scene.frame.graph.blocks;
    ASSERT_EQ(blocks.size(), rebuilt.frame.graph.blocks.size());
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        SCOPED_TRACE(i);
        const RowBlock& expected = rebuilt.frame.graph.blocks[i];
        EXPECT_EQ(blocks[i].kind, expected.kind);
        EXPECT_EQ(blocks[i].key, expected.key);
        EXPECT_EQ(blocks[i].source, expected.source);
        EXPECT_EQ(blocks[i].a, expected.a);
        EXPECT_EQ(blocks[i].b, expected.b);
        EXPECT_EQ(blocks[i].point_a_bs, expected.point_a_bs);
        EXPECT_EQ(blocks[i].point_b_bs, expected.point_b_bs);
        EXPECT_EQ(blocks[i].rotation_a_bs.coeffs(), expected.rotation_a_bs.coeffs());
        EXPECT_EQ(blocks[i].rotation_b_bs.coeffs(), expected.rotation_b_bs.coeffs());
        EXPECT_EQ(blocks[i].drive_velocity_ws_mps, expected.drive_velocity_ws_mps);
        EXPECT_EQ(blocks[i].drive_spin_ws_radps, expected.drive_spin_ws_radps);
        expect_same(blocks[i].joint, expected.joint);
        EXPECT_EQ(blocks[i].impulse_ws_ns, Vec3(Vec3::Zero()));
        EXPECT_EQ(blocks[i].angular_impulse_ws_nms, Vec3(Vec3::Zero()));
    }
}

TEST(BuildConstraints, RewrittenJointRowsEqualRebuiltOnes) {
    Random random(8);
    Building scene;
    for (std::uint32_t i = 4; i < 8; ++i) {
        scene.add_body(entity(i), {BodyKind::free, 2.0, Vec3(0.1, 0.2, 0.3), 0.5});
    }
    const auto add_joint = [&](std::uint32_t slot, Entity a, Entity b) {
        scene.persistent_id.add(entity(slot), {id_of(entity(slot))});
        Joint& joint = scene.joint.add(entity(slot));
        joint.a = a;
        joint.b = b;
        joint.frame_a_bs = random.pose();
        scene.joint_state.add(entity(slot));
    };
    add_joint(10, entity(4), entity(5));
    add_joint(11, entity(6), entity(4));
    add_joint(12, k_no_entity, entity(7));
    expect_equal_to_rebuilt(scene);
    ASSERT_EQ(scene.frame.graph.blocks.size(), 3U);
    for (RowBlock& block : scene.frame.graph.blocks) {
        block.impulse_ws_ns = Vec3(1.0, 2.0, 3.0);
        block.angular_impulse_ws_nms = Vec3(4.0, 5.0, 6.0);
        block.joint.lock_impulse = 7.0;
    }
    Joint& changed = scene.joint.at(entity(11));
    changed.friction = 4.0;
    changed.frame_a_bs = random.pose();
    changed.frame_b_bs = random.pose();
    changed.limited = true;
    changed.lower = -0.5;
    changed.upper = 0.25;
    changed.detent_spacing = 0.1;
    changed.detent_strength = 2.0;
    scene.joint_state.at(entity(11)) = {0.3, 0.2, false};
    expect_equal_to_rebuilt(scene);
    changed.latch.at = 0.125;
    changed.latch.strength = 3.0;
    scene.joint_state.at(entity(11)).latched = true;
    expect_equal_to_rebuilt(scene);
    changed.limited = false;
    scene.joint_state.at(entity(11)).latched = false;
    expect_equal_to_rebuilt(scene);
    scene.grip(k_right, GripKind::held, entity(7), random);
    expect_equal_to_rebuilt(scene);
    EXPECT_EQ(scene.frame.graph.blocks.size(), 4U);
    // One joint removed, one added: the same number, in other rows.
    scene.grab.at(k_right) = {};
    scene.joint.remove(entity(10));
    add_joint(13, entity(5), entity(6));
    expect_equal_to_rebuilt(scene);
    // A joint of a missing body has no rows.
    scene.joint.at(entity(13)).b = entity(20);
    expect_equal_to_rebuilt(scene);
    EXPECT_EQ(scene.frame.graph.blocks.size(), 2U);
    scene.joint.remove(entity(11));
    expect_equal_to_rebuilt(scene);
    EXPECT_EQ(scene.frame.graph.blocks.size(), 1U);
}

// Unchanged grips are rewritten in place; changed, added or removed ones are sorted in again.
TEST(BuildConstraints, RewrittenGripRowsEqualRebuiltOnes) {
    Random random(9);
    Building scene;
    scene.add_rock(5.0);
    scene.add_body(k_wall, {});
    scene.add_body(entity(5), {BodyKind::free, 2.0, Vec3(0.1, 0.2, 0.3), 0.5});
    const auto leave_impulses = [&] {
        for (RowBlock& block : scene.frame.graph.blocks) {
            block.impulse_ws_ns = Vec3(1.0, 2.0, 3.0);
            block.angular_impulse_ws_nms = Vec3(4.0, 5.0, 6.0);
        }
    };
    const auto expect_rows = [&](std::size_t count) {
        expect_equal_to_rebuilt(scene);
        EXPECT_EQ(scene.frame.graph.blocks.size(), count);
        leave_impulses();
    };
    scene.grip(k_left, GripKind::held, k_rock, random);
    scene.grip(k_right, GripKind::surface, k_wall, random);
    expect_rows(2);
    scene.grip(k_left, GripKind::held, k_rock, random);  // the same body at another point
    expect_rows(2);
    scene.grip(k_left, GripKind::surface, k_wall, random);  // the two grips swapped
    scene.grip(k_right, GripKind::held, k_rock, random);
    expect_rows(2);
    scene.grip(k_left, GripKind::held, k_rock, random).two_handed = true;
    scene.grab.at(k_right).two_handed = true;
    expect_rows(2);
    scene.grab.at(k_right) = {};
    scene.grab.at(k_left).two_handed = false;
    expect_rows(1);
    scene.grip(k_right, GripKind::held, entity(5), random);  // one removed, one added
    scene.grab.at(k_left) = {};
    expect_rows(1);
    scene.persistent_id.add(entity(10), {id_of(entity(10))});
    scene.joint.add(entity(10)).a = k_rock;
    scene.joint.at(entity(10)).b = entity(5);
    scene.joint_state.add(entity(10));
    scene.grip(k_left, GripKind::held, k_rock, random);
    expect_rows(3);
    scene.grip(k_left, GripKind::held, k_rock, random);
    expect_rows(3);
    scene.grab.at(k_left) = scene.grab.at(k_right) = {};
    expect_rows(1);
}

}  // namespace
}  // namespace handhold::build_constraints_reuse_test

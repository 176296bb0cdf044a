#include "systems/physics/build_constraints.hpp"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tests/systems/frame/column_scene.hpp"

namespace handhold::build_constraints_test {
namespace {

using test::distance;
using test::entity;
using test::Random;

constexpr Entity k_player = entity(0);
constexpr Entity k_left = entity(1);
constexpr Entity k_right = entity(2);
constexpr Entity k_wall = entity(3);
constexpr Entity k_rock = entity(4);

// Ids run against the slots, so that an order by slot would show.
std::uint64_t id_of(Entity entity) { return 100 - std::uint64_t{entity.slot}; }

struct Building {
    Column<PersistentId> persistent_id;
    Column<RigidBody> body;
    Column<BodyPose> body_pose;
    Column<BodyVelocity> body_velocity;
    Column<Joint> joint;
    Column<JointState> joint_state;
    Column<PlayerBody> player;
    Column<PlayerOrigin> origin;
    Column<PlayerVelocity> player_velocity;
    Column<HeadTracking> head;
    Column<HandOwner> owner;
    Column<Grab> grab;
    FrameGraph frame;
    Tuning tuning;

    explicit Building(std::initializer_list<Entity> hands = {k_left, k_right}) {
        persistent_id.add(k_player, {id_of(k_player)});
        player.add(k_player, {70.0});
        origin.add(k_player);
        player_velocity.add(k_player);
        head.add(k_player);
        for (const Entity entity : hands) {
            persistent_id.add(entity, {id_of(entity)});
            owner.add(entity, {k_player, entity == k_left ? HandSide::left : HandSide::right});
            grab.add(entity);
        }
        add_collider(k_player);
    }
    // As place_colliders lists them.
    void add_collider(Entity entity) {
        frame.entities.push_back(entity);
        std::sort(frame.entities.begin(), frame.entities.end(),
                  [](Entity x, Entity y) { return id_of(x) < id_of(y); });
        frame.proxies.clear();
        for (const Entity listed : frame.entities) {
            frame.proxies.emplace_back().id = id_of(listed);
        }
    }
    void add_body(Entity entity, const RigidBody& rigid, const Pose& pose = {},
                  const BodyVelocity& velocity = {}) {
        persistent_id.add(entity, {id_of(entity)});
        body.add(entity, rigid);
        body_pose.add(entity, {pose});
        body_velocity.add(entity, velocity);
        add_collider(entity);
    }
    void add_rock(double mass_kg) {
        add_body(k_rock, {BodyKind::free, mass_kg, Vec3(0.1, 0.2, 0.3), 0.5});
    }
    Grab& grip(Entity hand, GripKind kind, Entity gripped, Random& random) {
        Grab& grip = grab.at(hand);
        grip.kind = kind;
        grip.phase = GrabPhase::holding;
        grip.body = gripped;
        grip.anchor_bs = random.pose();
        grip.target_ps = random.pose();
        grip.target_velocity_ps_mps = random.vector(2.0);
        grip.target_spin_ps_radps = random.vector(2.0);
        return grip;
    }
    void run() {
        build_constraints({1.0 / 90.0, persistent_id, body, body_pose, body_velocity, joint,
                           joint_state, player, origin, player_velocity, head, owner, grab, frame},
                          tuning);
    }
    std::uint32_t index_of_body(Entity entity) const {
        return static_cast<std::uint32_t>(find_body(frame.graph, id_of(entity)));
    }
    const SolverBody& solver_body(Entity entity) const {
        return frame.graph.bodies[index_of_body(entity)];
    }
    const FrameGraph::PhaseBody& phase(Entity entity) const {
        return frame.phase[index_of_body(entity)];
    }
};

TEST(BuildConstraints, PlayerIsAMassThatNeverTurnsWithHisHeadAsCollider) {
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

TEST(BuildConstraints, HandsBecomeRowsFromTargetToAnchorDrivenInTheWorld) {
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

TEST(BuildConstraints, OfTwoHandsTheOneThatHoldsLongerHoldsThePointAndTheOtherTurns) {
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
            ASSERT_EQ(blocks.size(), two_handed ? 2U : 1U);  // too close: the first alone
            EXPECT_EQ(blocks[0].kind, two_handed ? RowKind::drive_point : RowKind::drive_weld);
            EXPECT_EQ(blocks[0].key, id_of(first));
            if (two_handed) {
                EXPECT_EQ(blocks[1].kind, RowKind::drive_direction);
            }
        }
    }
}

TEST(BuildConstraints, HandsOnWhatHangsOnJointsHoldAPointEach) {
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
TEST(BuildConstraints, ShareOfThePlayerFollowsTheDesignersCurve) {
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

TEST(BuildConstraints, HeaviestThingInTheHandsCounts) {
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

TEST(BuildConstraints, BodyWhoseColliderWasTakenAwayHoldsNothing) {
    Random random(5);
    Building scene;
    scene.persistent_id.add(k_rock, {id_of(k_rock)});
    scene.grip(k_right, GripKind::surface, k_rock, random);
    scene.run();
    EXPECT_TRUE(scene.frame.graph.blocks.empty());
    EXPECT_FALSE(scene.phase(k_player).grips_surface);
}

TEST(BuildConstraints, ContactsBecomeRowsAtTheCollidersCentre) {
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

TEST(BuildConstraints, NothingOfTheLastFrameStays) {
    Random random(6);
    Building scene;
    scene.add_rock(550.0);
    scene.grip(k_right, GripKind::held, k_rock, random);
    scene.run();
    scene.frame.phase[scene.index_of_body(k_player)].push_back_m = 3.0;
    scene.grab.at(k_right) = {};
    scene.run();
    EXPECT_TRUE(scene.frame.graph.blocks.empty());
    EXPECT_TRUE(scene.frame.graph.islands.empty());
    EXPECT_EQ(scene.phase(k_player).forward_share, 0.0);
    EXPECT_EQ(scene.phase(k_player).push_back_m, 0.0);
    EXPECT_FALSE(scene.phase(k_rock).held);
}

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

// A frame over the graph of the frame before, and over none.
void expect_as_built_anew(Building& scene) {
    Building anew = scene;
    anew.frame.graph = {};
    scene.run();
    anew.run();
    const std::vector<RowBlock>& blocks = scene.frame.graph.blocks;
    ASSERT_EQ(blocks.size(), anew.frame.graph.blocks.size());
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        SCOPED_TRACE(i);
        const RowBlock& expected = anew.frame.graph.blocks[i];
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

TEST(BuildConstraints, JointsOverThoseOfTheFrameBeforeAreAsBuiltAnew) {
    Random random(8);
    Building scene;
    for (std::uint32_t i = 4; i < 8; ++i) {
        scene.add_body(entity(i), {BodyKind::free, 2.0, Vec3(0.1, 0.2, 0.3), 0.5});
    }
    const auto tie = [&](std::uint32_t slot, Entity a, Entity b) {
        scene.persistent_id.add(entity(slot), {id_of(entity(slot))});
        Joint& joint = scene.joint.add(entity(slot));
        joint.a = a;
        joint.b = b;
        joint.frame_a_bs = random.pose();
        scene.joint_state.add(entity(slot));
    };
    tie(10, entity(4), entity(5));
    tie(11, entity(6), entity(4));
    tie(12, k_no_entity, entity(7));
    expect_as_built_anew(scene);
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
    expect_as_built_anew(scene);
    changed.latch.at = 0.125;
    changed.latch.strength = 3.0;
    scene.joint_state.at(entity(11)).latched = true;
    expect_as_built_anew(scene);
    changed.limited = false;
    scene.joint_state.at(entity(11)).latched = false;
    expect_as_built_anew(scene);
    scene.grip(k_right, GripKind::held, entity(7), random);
    expect_as_built_anew(scene);
    EXPECT_EQ(scene.frame.graph.blocks.size(), 4U);
    // One goes and one comes: as many as before, in other rows.
    scene.grab.at(k_right) = {};
    scene.joint.remove(entity(10));
    tie(13, entity(5), entity(6));
    expect_as_built_anew(scene);
    // One that ties what is gone has no rows.
    scene.joint.at(entity(13)).b = entity(20);
    expect_as_built_anew(scene);
    EXPECT_EQ(scene.frame.graph.blocks.size(), 2U);
    scene.joint.remove(entity(11));
    expect_as_built_anew(scene);
    EXPECT_EQ(scene.frame.graph.blocks.size(), 1U);
}

// Hands that go on are written where they were; hands that change what they hold, or how, come and
// go, are sorted in anew.
TEST(BuildConstraints, HandsOverThoseOfTheFrameBeforeAreAsBuiltAnew) {
    Random random(9);
    Building scene;
    scene.add_rock(5.0);
    scene.add_body(k_wall, {});
    scene.add_body(entity(5), {BodyKind::free, 2.0, Vec3(0.1, 0.2, 0.3), 0.5});
    const auto spoil = [&] {
        for (RowBlock& block : scene.frame.graph.blocks) {
            block.impulse_ws_ns = Vec3(1.0, 2.0, 3.0);
            block.angular_impulse_ws_nms = Vec3(4.0, 5.0, 6.0);
        }
    };
    const auto expect_rows = [&](std::size_t count) {
        expect_as_built_anew(scene);
        EXPECT_EQ(scene.frame.graph.blocks.size(), count);
        spoil();
    };
    scene.grip(k_left, GripKind::held, k_rock, random);
    scene.grip(k_right, GripKind::surface, k_wall, random);
    expect_rows(2);
    scene.frame.graph.places.clear();
    scene.grip(k_left, GripKind::held, k_rock, random);  // elsewhere: nothing is sorted for that
    scene.run();
    EXPECT_TRUE(scene.frame.graph.places.empty());
    expect_rows(2);
    scene.grip(k_left, GripKind::surface, k_wall, random);  // each what the other held
    scene.grip(k_right, GripKind::held, k_rock, random);
    expect_rows(2);
    scene.grip(k_left, GripKind::held, k_rock, random).two_handed = true;
    scene.grab.at(k_right).two_handed = true;
    expect_rows(2);
    scene.grab.at(k_right) = {};
    scene.grab.at(k_left).two_handed = false;
    expect_rows(1);
    scene.grip(k_right, GripKind::held, entity(5), random);  // one goes and one comes
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

TEST(BuildConstraints, OrderOfHandsAndBodiesDoesNotMatter) {
    Building forth;
    Building back({k_right, k_left});
    forth.add_rock(5.0);
    forth.add_body(k_wall, {});
    back.add_body(k_wall, {});
    back.add_rock(5.0);
    for (Building* const scene : {&forth, &back}) {
        Random random(7);
        scene->grip(k_left, GripKind::held, k_rock, random).two_handed = true;
        scene->grip(k_right, GripKind::held, k_rock, random).two_handed = true;
        scene->run();
    }
    ASSERT_EQ(forth.frame.graph.blocks.size(), 2U);
    ASSERT_EQ(back.frame.graph.blocks.size(), 2U);
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(forth.frame.graph.blocks[i].key, back.frame.graph.blocks[i].key);
        EXPECT_EQ(forth.frame.graph.blocks[i].point_a_bs, back.frame.graph.blocks[i].point_a_bs);
    }
    EXPECT_EQ(forth.frame.graph.island_bodies, back.frame.graph.island_bodies);
}

}  // namespace
}  // namespace handhold::build_constraints_test

#include "systems/physics/shared/restore_bodies.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "engine/solver/contact/moving_contacts.hpp"
#include "systems/physics/build_constraints.hpp"
#include "systems/physics/place_colliders.hpp"
#include "tests/systems/frame/column_scene.hpp"

namespace handhold::restore_bodies_test {
namespace {

using test::count_of;
using test::entity;
using test::k_wall;
using test::pose_at;
using test::Random;

constexpr Entity k_stuck = entity(10);
constexpr Entity k_follower = entity(11);
constexpr Entity k_alone = entity(12);
constexpr Entity k_mover = entity(13);
constexpr double k_half_m = 0.1;

// Cubes before a wall whose face is at x = 0.
struct Restoring {
    ShapeLibrary shapes;
    ShapeId cube = shapes.add_box(Vec3::Constant(k_half_m));
    ShapeId slab = shapes.add_box(Vec3(1.0, 4.0, 4.0));
    Column<PersistentId> persistent_id;
    Column<Collider> collider;
    Column<RigidBody> body;
    Column<BodyPose> body_pose;
    Column<BodyStart> body_start;
    Column<BodyVelocity> body_velocity;
    Column<LastValidPose> last_valid;
    Column<CollisionFilter> filter;
    Column<Joint> joint;
    Column<JointState> joint_state;
    Column<PlayerBody> player;
    Column<PlayerOrigin> origin;
    Column<PlayerStart> player_start;
    Column<PlayerVelocity> player_velocity;
    Column<HeadTracking> head;
    Column<HandOwner> owner;
    Column<Grab> grab;
    Column<BodyHold> body_hold;
    CollisionWorld collision{shapes};
    FrameGraph frame;
    Tuning tuning;
    StageStats stats;

    Restoring() { add(k_wall, BodyKind::fixed, slab, Vec3(-1.0, 0.0, 0.0)); }
    void add(Entity entity, BodyKind kind, ShapeId shape, const Vec3& valid) {
        persistent_id.add(entity, {100 + std::uint64_t{entity.slot}});
        collider.add(entity, {shape});
        body.add(entity, {kind, 1.0, Vec3::Constant(0.01), 0.0});
        body_pose.add(entity, {pose_at(valid)});
        body_start.add(entity, {pose_at(valid)});
        body_velocity.add(entity);
        last_valid.add(entity, {pose_at(valid), true});
    }
    void place() {
        place_colliders({.persistent_id = persistent_id,
                         .collider = collider,
                         .filter = filter,
                         .body = body,
                         .body_pose = body_pose,
                         .body_start = body_start,
                         .body_velocity = body_velocity,
                         .origin = origin,
                         .player_start = player_start,
                         .head = head,
                         .last_valid = last_valid,
                         .collision = collision,
                         .frame = frame},
                        tuning.head);
        build_constraints({.dt_s = 1.0 / 90.0,
                           .persistent_id = persistent_id,
                           .body = body,
                           .body_pose = body_pose,
                           .body_velocity = body_velocity,
                           .joint = joint,
                           .joint_state = joint_state,
                           .player = player,
                           .origin = origin,
                           .player_velocity = player_velocity,
                           .head = head,
                           .owner = owner,
                           .grab = grab,
                           .body_hold = body_hold,
                           .frame = frame},
                          tuning);
    }
    std::size_t index_of(Entity entity) const {
        return find_body(frame.graph, persistent_id.at(entity).value);
    }
    Vec3 solved_at(Entity entity) const {
        return frame.graph.bodies[index_of(entity)].pose_ws.position;
    }
    void end_phases_at(Entity entity, const Vec3& position) {
        const std::size_t index = index_of(entity);
        frame.graph.bodies[index].pose_ws.position = position;
        frame.active.add(static_cast<std::uint32_t>(index));
    }
    void restore() {
        refresh_contacts({collision, frame.proxies, frame.contacts, frame.graph,
                          frame.fresh_contacts, frame.proxy_updates, frame.active.list},
                         {tuning.contact.margin_m, tuning.contact.sweep_m}, OldPoints::replaced);
        restore_penetrating_bodies(collision, frame, tuning.contact, stats);
    }
};

TEST(RestoreBodies, CubeInWallReturnsToItsLastValidPose) {
    Restoring scene;
    const Vec3 valid(0.3, 0.0, 0.0);
    scene.add(k_stuck, BodyKind::free, scene.cube, valid);
    scene.place();
    scene.end_phases_at(k_stuck, Vec3(-0.05, 0.0, 0.0));
    scene.restore();
    EXPECT_LT((scene.solved_at(k_stuck) - valid).norm(), 1e-12);
    EXPECT_EQ(count_of(scene.stats, Fallback::restored_last_valid_pose), 1U);
}

// One cube ends deep in the wall; another has moved to where the first one returns to.
TEST(RestoreBodies, NoBodyOverlapsWhereARestoredOneReturnsTo) {
    Random random(3601);
    for (int i = 0; i < 100; ++i) {
        Restoring scene;
        const Vec3 valid{random.between(0.15, 0.4), random.between(-0.5, 0.5),
                         random.between(-0.5, 0.5)};
        const Vec3 beside = valid + Vec3(0.3, 0.0, 0.0);
        scene.add(k_stuck, BodyKind::free, scene.cube, valid);
        scene.add(k_follower, BodyKind::free, scene.cube, beside);
        scene.place();
        scene.end_phases_at(k_stuck, Vec3(-0.35, valid.y(), valid.z()));
        scene.end_phases_at(k_follower, valid + Vec3(random.between(0.02, 0.18), 0.0, 0.0));
        scene.restore();
        EXPECT_LT((scene.solved_at(k_stuck) - valid).norm(), 1e-12);
        EXPECT_GE(std::abs(scene.solved_at(k_follower).x() - valid.x()), 2.0 * k_half_m - 1e-3);
    }
}

// A fast cube ends a little in the wall, and another has followed it to its last valid pose, much
// deeper than the first is in the wall.
TEST(RestoreBodies, CubeThatHasTakenTheLastValidPoseIsRestoredToo) {
    Random random(3602);
    for (int i = 0; i < 100; ++i) {
        const Vec3 end{k_half_m - random.between(0.0015, 0.01), random.between(-0.5, 0.5), 0.0};
        const Vec3 followed_m(2.0 * k_half_m + random.between(0.0, 0.01), 0.0, 0.0);
        const Vec3 way_m(random.between(0.03, 0.1), 0.0, 0.0);
        Restoring scene;
        scene.add(k_stuck, BodyKind::free, scene.cube, end + way_m);
        scene.add(k_follower, BodyKind::free, scene.cube, end + followed_m + way_m);
        scene.place();
        scene.end_phases_at(k_stuck, end);
        scene.end_phases_at(k_follower, end + followed_m);
        scene.restore();
        EXPECT_LT((scene.solved_at(k_stuck) - end - way_m).norm(), 1e-12) << i;
        EXPECT_LT((scene.solved_at(k_follower) - end - followed_m - way_m).norm(), 1e-12) << i;
    }
}

// A mover that cannot be restored has taken the last valid pose.
TEST(RestoreBodies, CubeWhoseRestoreCannotHelpStaysAndOthersAreRestored) {
    constexpr std::uint64_t k_most_searches = 4;  // the first one is the test's
    Random random(3603);
    for (int i = 0; i < 100; ++i) {
        const Vec3 end{k_half_m - random.between(0.002, 0.01), random.between(-0.5, 0.5), 0.0};
        const Vec3 mover = end + Vec3(2.0 * k_half_m, 0.0, 0.0);
        const Vec3 way_m(random.between(0.03, 0.1), 0.0, 0.0);
        const Vec3 alone(0.3, 0.0, 2.0);
        Restoring scene;
        scene.add(k_stuck, BodyKind::free, scene.cube, end + way_m);
        scene.add(k_mover, BodyKind::kinematic, scene.cube, mover + way_m);
        scene.body_pose.at(k_mover).pose_ws = pose_at(mover);
        scene.add(k_alone, BodyKind::free, scene.cube, alone);
        scene.place();
        scene.end_phases_at(k_stuck, end);
        scene.end_phases_at(k_alone, alone - Vec3(0.25, 0.0, 0.0));
        SolverBody& stuck = scene.frame.graph.bodies[scene.index_of(k_stuck)];
        stuck.velocity_mps = random.vector(10.0);
        const Vec3 velocity_mps = stuck.velocity_mps;
        scene.restore();
        EXPECT_EQ(scene.solved_at(k_stuck), end);
        EXPECT_EQ(stuck.velocity_mps, velocity_mps);
        EXPECT_LT((scene.solved_at(k_alone) - alone).norm(), 1e-12);
        EXPECT_LE(scene.stats.contact_rounds, k_most_searches);
        EXPECT_EQ(count_of(scene.stats, Fallback::restored_last_valid_pose), 1U);
    }
}

// A follower overlaps two cubes where they return to: one that only the wall holds, and one whose
// place a mover has taken.
TEST(RestoreBodies, FollowerOfTwoIsRestoredWithTheOneThatCanBe) {
    Random random(3605);
    for (int i = 0; i < 100; ++i) {
        const double overlap_m = random.between(0.005, 0.03);
        const double apart_m = 2.0 * (2.0 * k_half_m - overlap_m);
        const double sign = i % 2 == 0 ? 1.0 : -1.0;  // either may come first
        const Vec3 loose(0.35, 0.0, 0.0);
        const Vec3 jammed = loose + Vec3(0.0, sign * apart_m, 0.0);
        const Vec3 follower = loose + Vec3(0.0, 0.5 * sign * apart_m, 0.0);
        const Vec3 follower_valid = follower + Vec3(0.5, 0.0, 0.0);
        const Vec3 jammed_end(k_half_m - 0.005, jammed.y(), 0.0);
        Restoring scene;
        scene.add(k_stuck, BodyKind::free, scene.cube, i % 4 < 2 ? loose : jammed);
        scene.add(k_alone, BodyKind::free, scene.cube, i % 4 < 2 ? jammed : loose);
        scene.add(k_follower, BodyKind::free, scene.cube, follower_valid);
        const Vec3 mover = jammed_end + Vec3(2.0 * k_half_m, sign * k_half_m, 0.0);
        scene.add(k_mover, BodyKind::kinematic, scene.cube, mover + Vec3(0.1, 0.0, 0.0));
        scene.body_pose.at(k_mover).pose_ws = pose_at(mover);
        scene.place();
        const Entity loose_cube = i % 4 < 2 ? k_stuck : k_alone;
        const Entity jammed_cube = i % 4 < 2 ? k_alone : k_stuck;
        scene.end_phases_at(loose_cube, loose - Vec3(1.0, 0.0, 0.0));
        scene.end_phases_at(jammed_cube, jammed_end);
        scene.end_phases_at(k_follower, follower);
        scene.restore();
        EXPECT_LT((scene.solved_at(loose_cube) - loose).norm(), 1e-12) << i;
        EXPECT_LT((scene.solved_at(k_follower) - follower_valid).norm(), 1e-12) << i;
        EXPECT_EQ(scene.solved_at(jammed_cube), jammed_end) << i;
    }
}

TEST(RestoreBodies, CubeThatWasDraggedFarStays) {
    Restoring scene;
    const Vec3 end(0.0, 0.0, 0.0);
    scene.add(k_stuck, BodyKind::free, scene.cube, Vec3(3.0, 0.0, 0.0));
    scene.place();
    scene.end_phases_at(k_stuck, end);
    scene.restore();
    EXPECT_EQ(scene.solved_at(k_stuck), end);
    EXPECT_EQ(count_of(scene.stats, Fallback::restored_last_valid_pose), 0U);
}

}  // namespace
}  // namespace handhold::restore_bodies_test

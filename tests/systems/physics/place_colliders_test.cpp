#include "systems/physics/place_colliders.hpp"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "components/play_space.hpp"
#include "tests/systems/frame/column_scene.hpp"

namespace handhold::place_colliders_test {
namespace {

using test::distance;
using test::entity;
using test::Random;

constexpr Entity k_player = entity(0);
constexpr Entity k_wall = entity(1);
constexpr Entity k_ship = entity(2);
constexpr Entity k_rock = entity(3);

// Ids descend with the slots, so that ordering by slot would be noticed.
PersistentId id_of(Entity entity) { return {100 - std::uint64_t{entity.slot}}; }

struct Placing {
    ShapeLibrary shapes;
    ShapeId box = shapes.add_box(Vec3(1.0, 1.0, 1.0));
    ShapeId ball = shapes.add_sphere(0.11);
    Column<PersistentId> persistent_id;
    Column<Collider> collider;
    Column<RigidBody> body;
    Column<BodyPose> body_pose;
    Column<BodyStart> body_start;
    Column<PlayerOrigin> origin;
    Column<PlayerStart> player_start;
    Column<HeadTracking> head;
    Column<LastValidPose> last_valid;
    Column<BodyVelocity> body_velocity;
    Column<CollisionFilter> filter;
    CollisionWorld collision{shapes};
    FrameGraph frame;

    void add_body(Entity entity, BodyKind kind, Random& random) {
        persistent_id.add(entity, id_of(entity));
        collider.add(entity, {box});
        body.add(entity, {kind, 1.0, Vec3::Ones(), 0.0});
        body_pose.add(entity, {random.pose(10.0)});
        body_start.add(entity, {random.pose(10.0)});
        last_valid.add(entity, {random.pose(10.0)});
    }
    void add_player(Random& random) {
        persistent_id.add(k_player, id_of(k_player));
        collider.add(k_player, {ball});
        origin.add(k_player, {random.pose(10.0)});
        player_start.add(k_player, {random.pose(10.0)});
        head.add(k_player);
        head.at(k_player).pose_ps = random.pose(1.0);
        last_valid.add(k_player, {random.pose(10.0), true});
    }
    void run(const HeadTuning& tuning = {}) {
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
                        tuning);
    }
    const ColliderProxy& proxy(Entity entity) const {
        return *std::ranges::find(frame.proxies, id_of(entity).value, &ColliderProxy::id);
    }
};

TEST(PlaceColliders, ProxiesAreSortedByPersistentIdWithTheirEntities) {
    Random random(1);
    Placing scene;
    scene.add_body(k_rock, BodyKind::free, random);
    scene.add_player(random);
    scene.add_body(k_wall, BodyKind::fixed, random);
    scene.add_body(k_ship, BodyKind::kinematic, random);
    scene.run();
    EXPECT_EQ(scene.frame.entities, (std::vector<Entity>{k_rock, k_ship, k_wall, k_player}));
    ASSERT_EQ(scene.frame.proxies.size(), 4U);
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(scene.frame.proxies[i].id, id_of(scene.frame.entities[i]).value);
        EXPECT_EQ(scene.frame.proxies[i].shape, scene.collider.at(scene.frame.entities[i]).shape);
    }
}

TEST(PlaceColliders, FreeBodiesStartAtTheirLastValidPoseOthersAtTheFramesStart) {
    Random random(2);
    Placing scene;
    scene.add_body(k_rock, BodyKind::free, random);
    scene.add_body(k_ship, BodyKind::kinematic, random);
    scene.add_body(k_wall, BodyKind::fixed, random);
    scene.run();
    for (const Entity entity : {k_rock, k_ship, k_wall}) {
        const bool free = entity == k_rock;
        EXPECT_EQ(scene.proxy(entity).free, free);
        EXPECT_EQ(distance(scene.proxy(entity).to_ws, scene.body_pose.at(entity).pose_ws), 0.0);
        const Pose& from =
            free ? scene.last_valid.at(entity).pose_ws : scene.body_start.at(entity).pose_ws;
        EXPECT_EQ(distance(scene.proxy(entity).from_ws, from), 0.0);
    }
}

RC_GTEST_PROP(PlaceColliders, PlayersAreTheSphereOfTheirHead, (std::uint64_t seed)) {
    Random random(seed);
    Placing scene;
    scene.add_player(random);
    scene.head.at(k_player).state = TrackingState::tracked;
    HeadTuning tuning;
    tuning.center_m = random.vector(0.2);
    scene.run(tuning);
    const Vec3 center_ps = transform_point(scene.head.at(k_player).pose_ps, tuning.center_m);
    const Vec3 center_ws = transform_point(scene.origin.at(k_player).pose_ws, center_ps);
    RC_ASSERT((scene.proxy(k_player).to_ws.position - center_ws).norm() < 1e-13);
    RC_ASSERT(distance(scene.proxy(k_player).from_ws, scene.last_valid.at(k_player).pose_ws) ==
              0.0);
    RC_ASSERT(scene.proxy(k_player).free);
}

TEST(PlaceColliders, HeadThatWasNeverTrackedHasAnInvalidPose) {
    Random random(4);
    Placing scene;
    scene.add_player(random);
    scene.head.at(k_player).state = TrackingState::never;
    scene.run();
    EXPECT_FALSE(is_valid(scene.proxy(k_player).to_ws));  // invalid poses take no part in collision
}

TEST(PlaceColliders, HeadWithoutALastValidPoseIsSweptFromTheStartOfTheFrame) {
    Random random(3);
    Placing scene;
    scene.add_player(random);
    scene.last_valid.at(k_player).known = false;
    scene.head.at(k_player).state = TrackingState::lost;  // frozen, but present
    scene.run();
    const Pose head_ps{head_center_ps(scene.head.at(k_player), {}), Quat::Identity()};
    EXPECT_EQ(
        distance(scene.proxy(k_player).from_ws, scene.player_start.at(k_player).pose_ws * head_ps),
        0.0);
}

TEST(PlaceColliders, ResultDoesNotDependOnInsertionOrderAndIsIdempotent) {
    Placing forth;
    Placing back;
    Random first(4);
    forth.add_body(k_wall, BodyKind::fixed, first);
    Random second(5);
    forth.add_body(k_rock, BodyKind::free, second);
    Random second_again(5);
    back.add_body(k_rock, BodyKind::free, second_again);
    Random first_again(4);
    back.add_body(k_wall, BodyKind::fixed, first_again);
    forth.run();
    back.run();
    back.run();
    EXPECT_EQ(forth.frame.entities, back.frame.entities);
    for (const Entity entity : {k_wall, k_rock}) {
        EXPECT_EQ(distance(forth.proxy(entity).to_ws, back.proxy(entity).to_ws), 0.0);
        EXPECT_EQ(distance(forth.proxy(entity).from_ws, back.proxy(entity).from_ws), 0.0);
    }
}

TEST(PlaceColliders, BodyWithoutAColliderIsListedButTouchesNothing) {
    Random random(7);
    Placing scene;
    scene.add_body(k_wall, BodyKind::fixed, random);
    scene.add_body(k_rock, BodyKind::free, random);
    scene.body_pose.at(k_wall).pose_ws = {Vec3(0.0, 3.0, 0.0), Quat::Identity()};
    scene.body_pose.at(k_rock).pose_ws = {Vec3(0.0, -30.0, 0.0), Quat::Identity()};
    scene.run();
    scene.collider.remove(k_wall);
    scene.run();
    EXPECT_EQ(scene.frame.entities, (std::vector<Entity>{k_rock, k_wall}));
    EXPECT_EQ(scene.proxy(k_wall).shape, k_no_shape);
    EXPECT_FALSE(scene.collision.cast_ray(Vec3::Zero(), Vec3(0.0, 10.0, 0.0)).has_value());
}

TEST(PlaceColliders, CollisionWorldHasTheProxies) {
    Random random(6);
    Placing scene;
    scene.add_body(k_wall, BodyKind::fixed, random);
    scene.body_pose.at(k_wall).pose_ws = {Vec3(0.0, 3.0, 0.0), Quat::Identity()};
    scene.run();
    const auto hit = scene.collision.cast_ray(Vec3::Zero(), Vec3(0.0, 10.0, 0.0));
    ASSERT_TRUE(hit.has_value());
    EXPECT_EQ(hit->id, id_of(k_wall).value);
    EXPECT_NEAR(hit->distance_m, 2.0, 1e-9);
}

}  // namespace
}  // namespace handhold::place_colliders_test

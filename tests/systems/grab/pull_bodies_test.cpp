#include "systems/grab/pull_bodies.hpp"

#include <algorithm>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "engine/collision/collision_world.hpp"
#include "tests/systems/frame/column_scene.hpp"

namespace handhold::pull_bodies_test {
namespace {

using test::count_of;
using test::count_of_all;
using test::entity;
using test::k_left;
using test::k_player;
using test::k_right;

constexpr Entity k_stone = entity(5);
constexpr Entity k_other = entity(6);
constexpr double k_dt_s = 0.01;
constexpr double k_player_kg = 80.0;
constexpr double k_stone_kg = 2.0;
constexpr double k_stone_m = 0.1;  // radius

// A player at the origin, whose palms look down (-Y); bodies are added by hand. Everything is put
// into the world through frame_ws.
struct Pulls {
    Pose frame_ws;
    ShapeLibrary shapes;
    std::vector<ColliderProxy> proxies;
    Column<PersistentId> persistent_id;
    Column<HandOwner> owner;
    Column<HandTracking> hand;
    Column<Grab> grab;
    Column<HandSight> sight;
    Column<PlayerBody> player;
    Column<PlayerOrigin> origin;
    Column<RigidBody> body;
    Column<BodyPose> body_pose;
    JointGroups joint_groups;
    Column<HandPull> pull;
    Column<GrabRule> grab_rule;
    Column<GrabLayers> grab_layers;
    Column<CollisionFilter> filter;
    Column<BodyVelocity> body_velocity;
    Column<PlayerVelocity> player_velocity;
    Tuning tuning;
    StageStats stats;

    explicit Pulls(const Pose& frame = {}) : frame_ws(frame) {
        tuning.pull.reach_m = 3.0;
        persistent_id.add(k_player, {100});
        origin.add(k_player, {frame_ws});
        player.add(k_player, {k_player_kg});
        player_velocity.add(k_player);
        for (const Entity hand_entity : {k_left, k_right}) {
            const HandSide side = hand_entity == k_left ? HandSide::left : HandSide::right;
            owner.add(hand_entity, {k_player, side});
            hand.add(hand_entity);
            grab.add(hand_entity);
            sight.add(hand_entity);
        }
    }
    void add_stone(Entity stone, const Vec3& center, double mass_kg = k_stone_kg,
                   BodyKind kind = BodyKind::free) {
        add_body(stone, shapes.add_sphere(k_stone_m), center, mass_kg, kind);
    }
    void add_body(Entity added, ShapeId shape, const Vec3& center, double mass_kg, BodyKind kind) {
        persistent_id.add(added, {200 + std::uint64_t{added.slot}});
        body.add(added, {kind, mass_kg, Vec3::Constant(0.01), 0.0});
        const Pose pose = frame_ws * test::pose_at(center);
        body_pose.add(added, {pose});
        body_velocity.add(added);
        proxies.push_back(
            {persistent_id.at(added).value, shape, pose, pose, kind == BodyKind::free});
    }
    void move_body(Entity moved, const Vec3& center) {
        BodyPose& pose = body_pose.at(moved);
        pose.pose_ws = frame_ws * test::pose_at(center);
        for (ColliderProxy& proxy : proxies) {
            if (proxy.id == persistent_id.at(moved).value) {
                proxy.from_ws = proxy.to_ws = pose.pose_ws;
            }
        }
    }
    // The hand closes, and stays closed, where its palm is at `palm`.
    void close(Entity closed, const Vec3& palm) {
        Vec3 center = tuning.hand.palm_center_m;
        center.x() *= owner.at(closed).side == HandSide::right ? 1.0 : -1.0;
        HandTracking& tracking = hand.at(closed);
        tracking.state = TrackingState::tracked;
        tracking.pressed = true;
        tracking.edge = GrabEdge::onset;
        tracking.pose_ps = tracking.start_ps = tracking.edge_ps = test::pose_at(palm - center);
    }
    void run() {
        CollisionWorld collision(shapes);
        std::ranges::sort(proxies, {}, &ColliderProxy::id);
        collision.set_proxies(proxies);
        stats = {};
        pull_bodies({.dt_s = k_dt_s,
                     .surfaces = collision,
                     .persistent_id = persistent_id,
                     .owner = owner,
                     .hand = hand,
                     .grab = grab,
                     .sight = sight,
                     .player = player,
                     .origin = origin,
                     .body = body,
                     .body_pose = body_pose,
                     .joint_groups = joint_groups,
                     .rules = {.rule = grab_rule, .layers = grab_layers, .filter = filter},
                     .pull = pull,
                     .body_velocity = body_velocity,
                     .player_velocity = player_velocity},
                    tuning, stats);
        for (HandTracking& tracking : hand.elements()) {
            tracking.edge = GrabEdge::none;
        }
    }
    Vec3 momentum() const {
        Vec3 sum = player.at(k_player).mass_kg * player_velocity.at(k_player).linear_mps;
        for (std::size_t index = 0; index < body.size(); ++index) {
            sum +=
                body.elements()[index].mass_kg * body_velocity.at(body.owners()[index]).linear_mps;
        }
        return sum;
    }
};

TEST(PullBodies, FirstFrameGivesTheWholeForceAlongTheWayAndTakesItFromThePlayer) {
    Pulls pulls;
    pulls.add_stone(k_stone, Vec3(0.3, -0.8, 0.0));
    pulls.close(k_right, Vec3(0.3, 1.0, 0.0));
    pulls.run();
    ASSERT_TRUE(pulls.pull.contains(k_right));
    EXPECT_EQ(pulls.pull.at(k_right).body, k_stone);
    const double impulse_ns = pulls.tuning.pull.force_n * k_dt_s;
    const Vec3 stone_mps = pulls.body_velocity.at(k_stone).linear_mps;
    EXPECT_LT((stone_mps - Vec3(0.0, impulse_ns / k_stone_kg, 0.0)).norm(), 1e-12);
    const Vec3 player_mps = pulls.player_velocity.at(k_player).linear_mps;
    EXPECT_LT((player_mps + Vec3(0.0, impulse_ns / k_player_kg, 0.0)).norm(), 1e-12);
    EXPECT_EQ(count_of_all(pulls.stats), 0U);
}

// Near the palm the speed is the one that half of the force can stop: sqrt(force / reduced mass *
// distance), with the distance from the palm to the surface.
TEST(PullBodies, SpeedNearThePalmIsWhatHalfTheForceCanStopBeforeTheSurfaceTouches) {
    Pulls pulls;
    constexpr double k_way_m = 0.05;
    pulls.add_stone(k_stone, Vec3(0.0, 1.0 - k_stone_m - k_way_m, 0.0));
    pulls.close(k_right, Vec3(0.0, 1.0, 0.0));
    pulls.run();
    for (int frame = 0; frame < 200; ++frame) {
        pulls.run();  // poses do not change here, only speeds
    }
    const double reduced_kg = k_stone_kg * k_player_kg / (k_stone_kg + k_player_kg);
    const double expected_mps = std::sqrt(pulls.tuning.pull.force_n / reduced_kg * k_way_m);
    const double closing_mps = pulls.body_velocity.at(k_stone).linear_mps.y() -
                               pulls.player_velocity.at(k_player).linear_mps.y();
    EXPECT_NEAR(closing_mps, expected_mps, 1e-9);
    EXPECT_LT(pulls.momentum().norm(), 1e-12);
}

TEST(PullBodies, WhatTouchesThePalmIsStopped) {
    Pulls pulls;
    pulls.add_stone(k_stone, Vec3(0.0, 1.0 - k_stone_m, 0.0));
    pulls.body_velocity.at(k_stone).linear_mps = Vec3(0.05, 0.02, 0.0);
    const Vec3 before = pulls.momentum();
    pulls.close(k_right, Vec3(0.0, 1.0, 0.0));
    pulls.run();
    const Vec3 against =
        pulls.body_velocity.at(k_stone).linear_mps - pulls.player_velocity.at(k_player).linear_mps;
    EXPECT_LT(against.norm(), 0.01);  // speed left for the last micrometre
    EXPECT_LT((pulls.momentum() - before).norm(), 1e-12);
}

TEST(PullBodies, HandThatMovesTakesItAlong) {
    Pulls still;
    Pulls moved;
    for (Pulls* pulls : {&still, &moved}) {
        pulls->tuning.pull.force_n = 1e6;  // at once
        pulls->add_stone(k_stone, Vec3(0.0, 0.0, 0.0));
        pulls->close(k_right, Vec3(0.0, 1.0, 0.0));
    }
    const Vec3 palm_mps(0.4, -0.2, 0.1);
    moved.hand.at(k_right).pose_ps.position += k_dt_s * palm_mps;
    still.run();
    moved.run();
    const auto against = [](const Pulls& pulls) {
        return Vec3(pulls.body_velocity.at(k_stone).linear_mps -
                    pulls.player_velocity.at(k_player).linear_mps);
    };
    EXPECT_LT((against(moved) - against(still) - palm_mps).norm(), 1e-9);
}

TEST(PullBodies, RefusesWhatIsFixedHeavyHeldOrJointedAndCounts) {
    const auto refused = [](Fallback reason, const auto& prepare) {
        Pulls pulls;
        pulls.add_stone(k_stone, Vec3::Zero());
        pulls.add_stone(k_other, Vec3(2.0, 0.0, 0.0));
        prepare(pulls);
        pulls.close(k_right, Vec3(0.0, 1.0, 0.0));
        pulls.run();
        EXPECT_EQ(count_of(pulls.stats, reason), 1U);
        EXPECT_EQ(count_of_all(pulls.stats), 1U);
        EXPECT_FALSE(pulls.pull.contains(k_right));
        EXPECT_EQ(pulls.body_velocity.at(k_stone).linear_mps, Vec3(Vec3::Zero()));
    };
    refused(Fallback::pull_refused_fixed,
            [](Pulls& pulls) { pulls.body.at(k_stone).kind = BodyKind::kinematic; });
    refused(Fallback::pull_refused_heavy, [](Pulls& pulls) {
        pulls.body.at(k_stone).mass_kg = pulls.tuning.pull.max_mass_kg + 0.1;
    });
    refused(Fallback::pull_refused_held, [](Pulls& pulls) {
        pulls.grab.at(k_left).kind = GripKind::held;
        pulls.grab.at(k_left).body = k_stone;
    });
    refused(Fallback::pull_refused_held, [](Pulls& pulls) {
        pulls.hand.at(k_left).pressed = true;
        pulls.hand.at(k_left).state = TrackingState::tracked;
        pulls.pull.add(k_left, {k_stone, 0.0});
        pulls.tuning.pull.force_n = 0.0;  // the other hand's pull has no force
    });
    refused(Fallback::pull_refused_fixed, [](Pulls& pulls) {
        pulls.joint_groups = {{0, 0}, {0, 0}};  // joined to the other body
    });
    refused(Fallback::pull_refused_fixed, [](Pulls& pulls) {
        pulls.joint_groups = {{0, 1}, {1, 0}};  // joined to an immovable body
    });
}

TEST(PullBodies, EndsWhereTheHandOpensGripsOrIsLost) {
    const auto ends = [](std::uint64_t counted, const auto& change) {
        Pulls pulls;
        pulls.add_stone(k_stone, Vec3::Zero());
        pulls.close(k_right, Vec3(0.0, 1.0, 0.0));
        pulls.run();
        ASSERT_TRUE(pulls.pull.contains(k_right));
        const Vec3 before = pulls.body_velocity.at(k_stone).linear_mps;
        change(pulls);
        pulls.run();
        EXPECT_FALSE(pulls.pull.contains(k_right));
        EXPECT_EQ(pulls.body_velocity.at(k_stone).linear_mps, before);
        EXPECT_EQ(count_of(pulls.stats, Fallback::pull_lost), counted);
    };
    ends(0, [](Pulls& pulls) { pulls.hand.at(k_right).pressed = false; });
    ends(0, [](Pulls& pulls) { pulls.grab.at(k_right).kind = GripKind::surface; });
    ends(0, [](Pulls& pulls) { pulls.tuning.pull.reach_m = 0.0; });
    ends(1, [](Pulls& pulls) { pulls.hand.at(k_right).state = TrackingState::lost; });
    ends(1, [](Pulls& pulls) { pulls.hand.at(k_right).resumed = true; });
    ends(1, [](Pulls& pulls) { pulls.move_body(k_stone, Vec3(0.0, -9.0, 0.0)); });
    ends(1, [](Pulls& pulls) { pulls.body.at(k_stone).mass_kg = 1e3; });
}

// The middle of a pole of 14 m is out of reach, but the palm points at the pole's end. The distance
// of the end decides when the pull is given up.
TEST(PullBodies, PoleIsPulledByItsEndHoweverFarItsMiddleIs) {
    constexpr double k_half_m = 7.0;
    Pulls pulls;
    const auto middle_below_end = [](double end_y) { return Vec3(0.0, end_y - k_half_m, 0.0); };
    const ShapeId pole = pulls.shapes.add_box(Vec3(0.02, k_half_m, 0.02));
    pulls.add_body(k_stone, pole, middle_below_end(-0.5), k_stone_kg, BodyKind::free);
    pulls.close(k_right, Vec3(0.0, 1.0, 0.0));
    for (int frame = 0; frame < 3; ++frame) {
        pulls.run();
        ASSERT_TRUE(pulls.pull.contains(k_right)) << frame;
        EXPECT_EQ(count_of_all(pulls.stats), 0U);
    }
    const double farthest_m = 1.5 * pulls.tuning.pull.reach_m + pulls.tuning.hand.reach_m;
    pulls.move_body(k_stone, middle_below_end(1.0 - farthest_m + 1e-3));
    pulls.run();
    EXPECT_TRUE(pulls.pull.contains(k_right));
    pulls.move_body(k_stone, middle_below_end(1.0 - farthest_m - 1e-3));
    pulls.run();
    EXPECT_FALSE(pulls.pull.contains(k_right));
    EXPECT_EQ(count_of(pulls.stats, Fallback::pull_lost), 1U);
}

TEST(PullBodies, MirroredHandAndMovedWorldDoTheSame) {
    const Pose moved_ws{Vec3(30.0, -7.0, 4.0), rotation_about(Vec3(0.6, 0.0, 0.8), 1.1)};
    const Vec3 stone(0.33, -0.5, 0.02);
    const Vec3 palm(0.3, 1.0, 0.0);
    Pulls right;
    right.add_stone(k_stone, stone);
    right.close(k_right, palm);
    right.run();
    const Vec3 expected = right.body_velocity.at(k_stone).linear_mps;
    ASSERT_GT(expected.norm(), 0.1);
    Pulls left;
    left.add_stone(k_stone, test::mirrored(stone));
    left.close(k_left, test::mirrored(palm));
    left.run();
    EXPECT_LT((left.body_velocity.at(k_stone).linear_mps - test::mirrored(expected)).norm(), 1e-12);
    Pulls moved(moved_ws);
    moved.add_stone(k_stone, stone);
    moved.close(k_right, palm);
    moved.run();
    EXPECT_LT((moved.body_velocity.at(k_stone).linear_mps - moved_ws.rotation * expected).norm(),
              1e-9);
}

}  // namespace
}  // namespace handhold::pull_bodies_test

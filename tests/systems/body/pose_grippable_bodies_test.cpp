// Bodies that hands can grip: a function of head and wrists alone.
#include "systems/body/pose_grippable_bodies.hpp"

#include <array>
#include <vector>

#include <gtest/gtest.h>

#include "systems/rigs/body_capsules.hpp"
#include "tests/systems/frame/column_scene.hpp"
#include "tests/systems/frame/two_players.hpp"

namespace handhold::pose_grippable_bodies_test {
namespace {

using test::Random;

constexpr std::size_t k_people = 3;
constexpr Entity player_of(std::size_t i) {
    return test::entity(static_cast<std::uint32_t>(10 * i));
}
constexpr Entity hand_of(std::size_t i, std::size_t side) {
    return test::entity(static_cast<std::uint32_t>(10 * i + 1 + side));
}

struct People {
    Column<PlayerOrigin> origin;
    Column<HeadTracking> head;
    Column<BodyMeasures> measures;
    Column<HandOwner> owner;
    Column<HandTracking> hand;
    Column<Grab> grab;
    Column<BodyHold> body_hold;
    Column<HandPull> pull;
    Column<GrippableBody> bodies;
    std::vector<GrippablePlayer> players;
    Tuning tuning;

    explicit People(Random& random, double apart_m) {
        for (std::size_t i = 0; i < k_people; ++i) {
            const Entity player = player_of(i);
            const double x = apart_m * static_cast<double>(i);
            origin.add(player, {Pose{Vec3(x, 0.0, 0.0), random.rotation()}});
            const Quat look = rotation_about(Vec3::UnitY(), random.between(-3.0, 3.0));
            HeadTracking& tracked = head.add(player);
            tracked.start_ps = tracked.pose_ps = {Vec3(0.0, 1.6, 0.0), look};
            tracked.state = TrackingState::tracked;
            measures.add(player);
            for (std::size_t side = 0; side < k_hand_count; ++side) {
                owner.add(hand_of(i, side), {player, static_cast<HandSide>(side)});
                const Vec3 at = Vec3(0.0, 1.3, 0.0) + random.vector(0.4);
                HandTracking& of_hand = hand.add(hand_of(i, side));
                of_hand.start_ps = of_hand.edge_ps = of_hand.pose_ps = {at, random.rotation()};
                of_hand.state = TrackingState::tracked;
                grab.add(hand_of(i, side));
            }
        }
    }
    void pose(Entity asking = k_no_entity) {
        pose_grippable_bodies({.origin = origin,
                               .head = head,
                               .measures = measures,
                               .owner = owner,
                               .hand = hand,
                               .grab = grab,
                               .body_hold = body_hold,
                               .pull = pull,
                               .asking = asking,
                               .bodies = bodies,
                               .players = players},
                              tuning);
    }
    Pose part_ps(std::size_t i, BodyPart part) const {
        const Entity player = player_of(i);
        return inverse(origin.at(player).pose_ws) *
               part_capsule(bodies.at(player), measures.at(player), part).frame_ws;
    }
};

TEST(GrippableBodies, AreThereForPlayersNearAClosingHandOfAnother) {
    Random random(1);
    People people(random, 1.0);
    people.pose();
    EXPECT_TRUE(people.bodies.empty());  // no hand closes
    people.hand.at(hand_of(0, 1)).edge = GrabEdge::onset;
    people.pose();
    EXPECT_FALSE(people.bodies.contains(player_of(0)));  // their own body
    EXPECT_TRUE(people.bodies.contains(player_of(1)));
    people.hand.at(hand_of(0, 1)).edge = GrabEdge::release;
    people.pull.add(hand_of(0, 0));
    people.pose();
    EXPECT_TRUE(people.bodies.contains(player_of(1)));
    people.pull.remove(hand_of(0, 0));
    people.pose(hand_of(2, 0));
    EXPECT_TRUE(people.bodies.contains(player_of(1)));
    EXPECT_FALSE(people.bodies.contains(player_of(2)));
    people.head.at(player_of(1)).state = TrackingState::never;
    people.pose(hand_of(2, 0));
    EXPECT_FALSE(people.bodies.contains(player_of(1)));
}

TEST(GrippableBodies, OfFarPlayersAreThereOnlyWhileTheyAreHeld) {
    Random random(2);
    People people(random, 100.0);
    people.hand.at(hand_of(0, 1)).edge = GrabEdge::onset;
    people.pose();
    EXPECT_TRUE(people.bodies.empty());
    people.grab.at(hand_of(0, 0)).kind = GripKind::player;
    people.grab.at(hand_of(0, 0)).body = player_of(2);
    people.body_hold.add(hand_of(0, 0));
    for (const TrackingState state : {TrackingState::tracked, TrackingState::never}) {
        people.head.at(player_of(2)).state = state;  // a restored world may have both
        people.pose();
        EXPECT_EQ(people.bodies.size(), 1U);
        EXPECT_TRUE(people.bodies.contains(player_of(2)));
    }
}

// Hands that are lost or were never tracked hang beside the trunk, wherever they were seen last. A
// lost hand that grips is where it was.
TEST(GrippableBodies, ArmsOfLostHandsAreNotStretched) {
    Random random(5);
    for (int i = 0; i < 500; ++i) {
        People people(random, 1.0);
        const HandSide side = random.between(0.0, 1.0) < 0.5 ? HandSide::left : HandSide::right;
        const Entity hand = hand_of(1, index_of(side));
        HandTracking& tracking = people.hand.at(hand);
        tracking.state =
            random.between(0.0, 1.0) < 0.5 ? TrackingState::never : TrackingState::lost;
        tracking.start_ps.position = tracking.pose_ps.position = random.vector(8.0);
        const bool grips = random.between(0.0, 1.0) < 0.2;
        people.grab.at(hand).kind = grips ? GripKind::surface : GripKind::none;
        people.grab.at(hand_of(0, 0)).kind = GripKind::player;
        people.grab.at(hand_of(0, 0)).body = player_of(1);
        people.body_hold.add(hand_of(0, 0));
        people.pose();
        const ArmPose::Arm& arm = people.bodies.at(player_of(1)).arms.arms[index_of(side)];
        if (grips) {
            const Vec3 wrist_ws =
                transform_point(people.origin.at(player_of(1)).pose_ws, tracking.start_ps.position);
            ASSERT_LT((arm.hand_ws.position - wrist_ws).norm(), 1e-9);
            continue;
        }
        const BodyMeasures& size = people.measures.at(player_of(1));
        ASSERT_LT((arm.hand_ws.position - arm.upper_ws.position).norm(),
                  1.3 * (size.upper_arm_m + size.forearm_m));
    }
}

// Equal inputs give equal bits, whatever was computed before; and the body moves with the play
// space.
TEST(GrippableBodies, DependOnHeadAndWristsAlone) {
    Random random(3);
    for (int i = 0; i < 50; ++i) {
        People people(random, 1.0);
        people.pose(hand_of(0, 0));
        const People again = people;
        const Pose motion = random.pose();
        people.origin.at(player_of(1)).pose_ws = motion * people.origin.at(player_of(1)).pose_ws;
        people.origin.at(player_of(0)).pose_ws = people.origin.at(player_of(1)).pose_ws;
        people.pose(hand_of(0, 0));
        for (std::size_t k = 0; k < k_gripped_parts; ++k) {
            const auto part = static_cast<BodyPart>(k);
            const Pose before = again.part_ps(1, part);
            const Pose after = people.part_ps(1, part);
            ASSERT_LE(test::distance(before, after), 1e-6) << k;
        }
        people.origin = again.origin;
        people.pose(hand_of(0, 0));
        for (std::size_t k = 0; k < k_gripped_parts; ++k) {
            const auto part = static_cast<BodyPart>(k);
            ASSERT_EQ(again.part_ps(1, part).position, people.part_ps(1, part).position) << k;
        }
    }
}

// Of players who keep still, it is the body that the frames show: nothing lags or swings.
TEST(GrippableBodies, OfStillPlayersAreTheShownOnes) {
    Random random(4);
    for (int i = 0; i < 12; ++i) {
        test::TwoPlayers scene;
        scene.add_players({"a", "b"}, {80.0, 80.0});
        for (std::size_t p = 0; p < 2; ++p) {
            const Vec3 head(2.0 * static_cast<double>(p), 1.6, 0.0);
            const Quat look = rotation_about(Vec3::UnitY(), random.between(-0.5, 0.5));
            scene.scripts[p].head = [=](double) { return Pose{head, look}; };
            for (std::size_t side = 0; side < k_hand_count; ++side) {
                const double across = side == 0 ? -1.0 : 1.0;
                const Vec3 offset{across * random.between(0.1, 0.4), random.between(-0.7, -0.1),
                                  random.between(-0.5, -0.2)};
                scene.scripts[p].hands[side] = [=](double) {
                    return Pose{head + offset, Quat::Identity()};
                };
            }
        }
        scene.drop_caches();
        scene.run(4.0);
        const World& w = scene.world;
        Column<GrippableBody> bodies;
        std::vector<GrippablePlayer> players;
        pose_grippable_bodies({.origin = w.player_origin,
                               .head = w.head_tracking,
                               .measures = w.body_measures,
                               .owner = w.hand_owner,
                               .hand = w.hand_tracking,
                               .grab = w.grab,
                               .body_hold = w.body_hold,
                               .pull = w.hand_pull,
                               .asking = scene.players[0].hands[0],
                               .bodies = bodies,
                               .players = players},
                              scene.tuning);
        const Entity player = scene.players[1].player;
        ASSERT_TRUE(bodies.contains(player));
        for (std::size_t k = 0; k < k_gripped_parts; ++k) {
            const auto part = static_cast<BodyPart>(k);
            const BodyMeasures& measures = w.body_measures.at(player);
            const PartCapsule shown = part_capsule(w.render_pose.at(player), measures, part);
            const PartCapsule found = part_capsule(bodies.at(player), measures, part);
            EXPECT_LE((shown.frame_ws.position - found.frame_ws.position).norm(), 2e-3) << k;
            EXPECT_LE((transform_point(shown.frame_ws, shown.end_bs) -
                       transform_point(found.frame_ws, found.end_bs))
                          .norm(),
                      2e-3)
                << k;
        }
    }
}

}  // namespace
}  // namespace handhold::pose_grippable_bodies_test

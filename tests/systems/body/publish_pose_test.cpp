#include "systems/body/publish_pose.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tests/systems/frame/column_scene.hpp"

namespace handhold::publish_pose_test {
namespace {

using test::distance;
using test::entity;
using test::Random;

constexpr Entity k_player = entity(0);
constexpr Entity k_left = entity(1);
constexpr Entity k_right = entity(2);

struct Publishing {
    std::vector<PushBack> push_backs;
    Column<PlayerOrigin> origin;
    Column<HeadTracking> head;
    Column<HandOwner> owner;
    Column<HandTracking> hand;
    Column<Grab> grab;
    Column<PalmPose> palm;
    Column<FingerPose> fingers;
    Column<AuthoredHold> authored_hold;
    Column<RenderPose> render;
    Tuning tuning;

    explicit Publishing(std::uint64_t seed,
                        std::initializer_list<Entity> hands = {k_left, k_right}) {
        Random random(seed);
        origin.add(k_player, {random.pose()});
        head.add(k_player);
        head.at(k_player).pose_ps = random.pose(1.0);
        render.add(k_player);
        for (const Entity entity : hands) {
            owner.add(entity, {k_player, entity == k_left ? HandSide::left : HandSide::right});
            hand.add(entity);
            grab.add(entity);
            palm.add(entity, {random.pose()});
            fingers.add(entity);
        }
        hand.at(k_left).pose_ps = random.pose(1.0);
        hand.at(k_right).pose_ps = random.pose(1.0);
    }
    const RenderPose& run() {
        publish_pose({.push_backs = push_backs,
                      .origin = origin,
                      .head = head,
                      .owner = owner,
                      .hand = hand,
                      .grab = grab,
                      .palm = palm,
                      .fingers = fingers,
                      .authored_hold = authored_hold,
                      .render = render},
                     tuning);
        return render.at(k_player);
    }
    const Pose& origin_ws() const { return origin.at(k_player).pose_ws; }
};

RC_GTEST_PROP(PublishPose, HeadAndHandsAreTheirTrackedPosesInTheWorld, (std::uint64_t seed)) {
    Publishing scene(seed);
    const RenderPose& out = scene.run();
    RC_ASSERT(distance(out.head_ws, scene.origin_ws() * scene.head.at(k_player).pose_ps) < 1e-7);
    RC_ASSERT(
        (out.head_center_ws - transform_point(out.head_ws, scene.tuning.head.center_m)).norm() <
        1e-13);
    for (const Entity hand : {k_left, k_right}) {
        const RenderPose::Hand& shown = out.hands[hand == k_left ? 0 : 1];
        RC_ASSERT(distance(shown.tracked_ws, scene.origin_ws() * scene.hand.at(hand).pose_ps) <
                  1e-7);
        RC_ASSERT(distance(shown.shown_ws, scene.palm.at(hand).pose_ws) == 0.0);
        RC_ASSERT(shown.grip == GripKind::none);
    }
}

TEST(PublishPose, FingersAndGripBelongToTheirHand) {
    Publishing scene(3);
    scene.grab.at(k_right).kind = GripKind::held;
    scene.fingers.at(k_right).shown[2].curl_rad[1] = 0.7;
    const RenderPose& out = scene.run();
    EXPECT_EQ(out.hands[1].grip, GripKind::held);
    EXPECT_EQ(out.hands[1].fingers[2].curl_rad[1], 0.7);
    EXPECT_EQ(out.hands[0].grip, GripKind::none);
    EXPECT_EQ(out.hands[0].fingers[2].curl_rad[1], 0.0);
}

// The ray passes through the palm along -Y of the hand and starts ray_back_m behind the skin.
RC_GTEST_PROP(PublishPose, RayRunsThroughThePalmAlongItsInwardNormal, (std::uint64_t seed)) {
    Publishing scene(seed);
    scene.tuning.hand.palm_center_m = Vec3(0.02, -0.01, -0.07);
    const RenderPose& out = scene.run();
    for (const HandSide side : {HandSide::left, HandSide::right}) {
        const RenderPose::Hand& hand = out.hands[index_of(side)];
        const Vec3 from = inverse_transform_point(hand.tracked_ws, hand.ray_from_ws);
        const Vec3 to = inverse_transform_point(hand.tracked_ws, hand.ray_to_ws);
        const double outward = side == HandSide::right ? 0.02 : -0.02;
        const Vec3 expected_from(outward, -0.01 + scene.tuning.hand.ray_back_m, -0.07);
        RC_ASSERT((from - expected_from).norm() < 1e-13);
        RC_ASSERT((to - (expected_from - Vec3(0.0, scene.tuning.hand.ray_length_m, 0.0))).norm() <
                  1e-13);
    }
}

TEST(PublishPose, PushBackBelongsToThePlayerAndIsZeroWithoutAnEntry) {
    Publishing scene(4);
    EXPECT_EQ(scene.run().push_back_m, 0.0);
    scene.push_backs = {{entity(9), 9.0}, {k_player, 0.25}};
    EXPECT_EQ(scene.run().push_back_m, 0.25);
}

RC_GTEST_PROP(PublishPose, MovedAndRotatedWorldMovesThePictureAlong, (std::uint64_t seed)) {
    Publishing here(seed);
    Publishing there(seed);
    Random random(seed + 1);
    const Pose moved = random.pose(1e3);
    there.origin.at(k_player).pose_ws = moved * here.origin_ws();
    there.palm.at(k_left).pose_ws = moved * here.palm.at(k_left).pose_ws;
    const RenderPose& a = here.run();
    const RenderPose& b = there.run();
    RC_ASSERT(distance(inverse(moved) * b.head_ws, a.head_ws) < 1e-6);
    RC_ASSERT(distance(inverse(moved) * b.hands[0].shown_ws, a.hands[0].shown_ws) < 1e-6);
    RC_ASSERT((inverse_transform_point(moved, b.hands[1].ray_to_ws) - a.hands[1].ray_to_ws).norm() <
              1e-9);
}

TEST(PublishPose, OrderOfHandsIsIrrelevant) {
    Publishing forth(5);
    Publishing back(5, {k_right, k_left});
    const RenderPose& a = forth.run();
    const RenderPose& b = back.run();
    for (std::size_t side = 0; side < k_hand_count; ++side) {
        EXPECT_EQ(a.hands[side].tracked_ws.position, b.hands[side].tracked_ws.position);
        EXPECT_EQ(a.hands[side].ray_to_ws, b.hands[side].ray_to_ws);
    }
}

}  // namespace
}  // namespace handhold::publish_pose_test

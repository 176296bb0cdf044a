#include "systems/grab/anchor_grabs.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tests/systems/grab/anchoring.hpp"

namespace handhold::anchor_grabs_test {
namespace {

using test::count_of;
using test::count_of_all;
using test::distance;
using test::pose_at;

// --- Fresh grips ---------------------------------------------------------------------------------

// Half way through the frame, body, origin and hand are at the means of their start and end.
TEST(AnchorGrabs, AnchorIsTheHandInTheBodyAtTheInstantOfTheEdge) {
    Anchoring scene;
    scene.move_player(pose_at(Vec3(1.0, 0.0, 0.0)), pose_at(Vec3(1.2, 0.0, 0.0)));
    scene.move_body(k_ship, pose_at(Vec3(0.0, 5.0, 0.0)), pose_at(Vec3(0.0, 5.4, 0.0)));
    scene.move_hand(k_right, pose_at(Vec3(0.0, 0.0, -1.0)), pose_at(Vec3(0.0, 0.0, -1.2)));
    scene.set_edge(k_right, GrabEdge::onset, 0.5);
    scene.set_grip(k_right, GripKind::held, GrabPhase::fresh, k_ship);
    scene.run();
    const Grab& grab = scene.grab.at(k_right);
    EXPECT_EQ(grab.phase, GrabPhase::holding);
    EXPECT_LT((grab.anchor_bs.position - Vec3(1.1, -5.2, -1.1)).norm(), 1e-12);
    EXPECT_EQ(count_of_all(scene.stats), 0U);
}

RC_GTEST_PROP(AnchorGrabs, NewGripHasNoErrorAtItsInstant, (std::uint64_t seed)) {
    Random random(seed);
    Anchoring scene = random_anchoring(random);
    const double t = random.between(0.0, 1.0);
    scene.set_edge(k_left, GrabEdge::onset, t);
    scene.set_grip(k_left, GripKind::held, GrabPhase::fresh, k_ship);
    scene.run();
    const Pose body =
        interpolate(scene.body_start.at(k_ship).pose_ws, scene.body_pose.at(k_ship).pose_ws, t);
    const Pose origin =
        interpolate(scene.player_start.at(k_player).pose_ws, scene.origin.at(k_player).pose_ws, t);
    RC_ASSERT(distance(body * scene.grab.at(k_left).anchor_bs,
                       origin * scene.hand.at(k_left).edge_ps) < 1e-7);
}

// The right hand holds the wall, so the player is where that hand puts them, not where they were
// predicted.
TEST(AnchorGrabs, SecondHandsAnchorGoesByTheHandThatAlreadyHolds) {
    Anchoring scene;
    scene.move_player(pose_at(Vec3::Zero()), pose_at(Vec3(9.0, 9.0, 9.0)));
    scene.move_hand(k_right, pose_at(Vec3(0.3, 1.0, 0.0)), pose_at(Vec3(0.3, 1.0, 0.2)));
    scene.set_grip(k_right, GripKind::surface, GrabPhase::holding, k_wall,
                   pose_at(Vec3(0.3, 1.0, 0.0)));
    scene.move_hand(k_left, pose_at(Vec3(-0.3, 1.0, 0.0)), pose_at(Vec3(-0.3, 1.0, 0.0)));
    scene.set_edge(k_left, GrabEdge::onset, 0.5);
    scene.set_grip(k_left, GripKind::surface, GrabPhase::fresh, k_wall);
    scene.run();
    // The holding hand has moved 0.1 m in z by then, so the origin is at -0.1 m.
    EXPECT_LT((scene.grab.at(k_left).anchor_bs.position - Vec3(-0.3, 1.0, -0.1)).norm(), 1e-12);
}

// A holding hand that does not move straight: its samples give the path in between.
TEST(AnchorGrabs, SecondHandsAnchorGoesByTheHoldersWayThroughItsSamples) {
    for (const double sampled_at : {0.25, 0.5, 0.75}) {
        Anchoring scene;
        scene.move_hand(k_right, pose_at(Vec3(0.3, 1.0, 0.0)), pose_at(Vec3(0.3, 1.0, 0.2)));
        HandHistory& history = scene.hand_history.at(k_right);
        const double sample_s = k_start_s + sampled_at * k_dt_s;
        history.entries[0] = {k_start_s - k_dt_s, pose_at(Vec3(9.0, 9.0, 9.0))};
        history.entries[1] = {sample_s, pose_at(Vec3(0.3, 1.4, 0.0))};
        history.entries[2] = {k_end_s, pose_at(Vec3(0.3, 1.0, 0.2))};
        history.count = history.next = 3;
        scene.set_grip(k_right, GripKind::surface, GrabPhase::holding, k_wall,
                       pose_at(Vec3(0.3, 1.0, 0.0)));
        scene.move_hand(k_left, pose_at(Vec3(-0.3, 1.0, 0.0)), pose_at(Vec3(-0.3, 1.0, 0.0)));
        scene.set_edge(k_left, GrabEdge::onset, 0.5);
        scene.set_grip(k_left, GripKind::surface, GrabPhase::fresh, k_wall);
        scene.run();
        // Up by 0.4 m until the sample, then down, and 0.2 m along z.
        const Vec3 way = sampled_at >= 0.5 ? Vec3(0.0, 0.4 * 0.5 / sampled_at, 0.0)
                                           : Vec3(0.0, 0.4 - 0.4 * 0.25 / 0.75, 0.2 * 0.25 / 0.75);
        EXPECT_LT((scene.grab.at(k_left).anchor_bs.position - (Vec3(-0.3, 1.0, 0.0) - way)).norm(),
                  1e-9);
    }
}

TEST(AnchorGrabs, GripsKeepTheirAnchorWhileNothingHappens) {
    Anchoring scene;
    const Pose anchor = pose_at(Vec3(0.1, 0.2, 0.3));
    scene.set_grip(k_right, GripKind::surface, GrabPhase::holding, k_wall, anchor);
    scene.move_hand(k_right, pose_at(Vec3(1.0, 0.0, 0.0)), pose_at(Vec3(1.02, 0.0, 0.0)));
    scene.run();
    scene.run();  // idempotent
    EXPECT_EQ(scene.grab.at(k_right).anchor_bs.position, anchor.position);
    EXPECT_EQ(scene.grab.at(k_right).phase, GrabPhase::holding);
    EXPECT_EQ(count_of_all(scene.stats), 0U);
}

TEST(AnchorGrabs, HandsThatHoldNothingAreLeftAlone) {
    Anchoring scene;
    scene.set_edge(k_right, GrabEdge::release, 0.5);
    scene.run();
    EXPECT_EQ(scene.grab.at(k_right).kind, GripKind::none);
    EXPECT_EQ(scene.grab.at(k_right).phase, GrabPhase::none);
}

// --- Targets -------------------------------------------------------------------------------------

TEST(AnchorGrabs, HoldingHandAimsAtItsTrackedPoseWithItsMeanVelocity) {
    Anchoring scene;
    const Pose from = pose_at(Vec3(1.0, 0.0, 0.0));
    const Pose to{Vec3(1.02, 0.0, -0.01), rotation_about(Vec3::UnitY(), 0.03)};
    scene.move_hand(k_right, from, to);
    scene.set_grip(k_right, GripKind::surface, GrabPhase::holding, k_wall);
    scene.run();
    const Grab& grab = scene.grab.at(k_right);
    EXPECT_EQ(distance(grab.target_ps, to), 0.0);
    EXPECT_LT((grab.target_velocity_ps_mps - Vec3(2.0, 0.0, -1.0)).norm(), 1e-9);
    EXPECT_LT((grab.target_spin_ps_radps - Vec3(0.0, 3.0, 0.0)).norm(), 1e-9);
}

// For the remaining 0.4 of the frame the hand moves on with the velocity of its release.
TEST(AnchorGrabs, OpeningHandCarriesOnWithItsReleaseVelocity) {
    Anchoring scene;
    HandTracking& hand = scene.hand.at(k_right);
    hand.release_velocity_ps_mps = Vec3(1.0, 2.0, 3.0);
    hand.release_spin_ps_radps = Vec3(0.0, 5.0, 0.0);
    scene.move_hand(k_right, pose_at(Vec3(0.5, 0.0, 0.0)), pose_at(Vec3(0.5, 0.0, 0.0)));
    scene.set_edge(k_right, GrabEdge::release, 0.6);
    scene.set_grip(k_right, GripKind::held, GrabPhase::releasing, k_ship);
    scene.run();
    const Grab& grab = scene.grab.at(k_right);
    EXPECT_EQ(grab.phase, GrabPhase::releasing);
    EXPECT_EQ(grab.target_velocity_ps_mps, Vec3(1.0, 2.0, 3.0));
    EXPECT_EQ(grab.target_spin_ps_radps, Vec3(0.0, 5.0, 0.0));
    const Pose expected{Vec3(0.504, 0.008, 0.012), rotation_about(Vec3::UnitY(), 0.02)};
    EXPECT_LT(distance(grab.target_ps, expected), 1e-12);
}

// --- Two hands -----------------------------------------------------------------------------------

// The hands disagree by 2 cm along x about the player's position; together they put the player in
// the middle.
TEST(AnchorGrabs, HandThatLeavesTwoOnWallsIsGoneAtOnceAndTheOtherStaysWhereItIs) {
    for (const Entity leaving : {k_left, k_right}) {
        Anchoring scene;
        const Entity staying = other_of(leaving);
        scene.move_hand(leaving, pose_at(Vec3(0.3, 1.0, 0.0)), pose_at(Vec3(0.3, 1.0, 0.0)));
        scene.move_hand(staying, pose_at(Vec3(-0.3, 1.0, 0.0)), pose_at(Vec3(-0.3, 1.0, 0.0)));
        scene.set_grip(leaving, GripKind::surface, GrabPhase::releasing, k_wall,
                       pose_at(Vec3(0.32, 1.0, 0.0)));
        scene.set_grip(staying, GripKind::surface, GrabPhase::holding, k_ship,
                       pose_at(Vec3(-0.3, 1.0, 0.0)));
        scene.set_edge(leaving, GrabEdge::release, 0.5);
        scene.run();
        EXPECT_EQ(scene.grab.at(leaving).kind, GripKind::none);
        EXPECT_EQ(scene.grab.at(leaving).phase, GrabPhase::none);
        EXPECT_EQ(count_of(scene.stats, Fallback::two_hand_grip_ended), 1U);
        EXPECT_EQ(scene.grab.at(staying).phase, GrabPhase::holding);
        EXPECT_LT((scene.grab.at(staying).anchor_bs.position - Vec3(-0.29, 1.0, 0.0)).norm(),
                  1e-12);
    }
}

// The leaving hand opened while it was not tracked, 20 cm from its anchor. The player stays where
// both hands put them.
TEST(AnchorGrabs, HandThatOpenedUnseenLeavesThePlayerWhereHeIs) {
    for (const Entity leaving : {k_left, k_right}) {
        Anchoring scene;
        const Entity staying = other_of(leaving);
        for (const Entity hand : {leaving, staying}) {
            scene.move_hand(hand, pose_at(Vec3(0.3, 1.0, 0.0)), pose_at(Vec3(0.3, 1.1, 0.0)));
        }
        scene.set_grip(leaving, GripKind::surface, GrabPhase::releasing, k_wall,
                       pose_at(Vec3(0.5, 1.0, 0.0)));
        scene.set_grip(staying, GripKind::surface, GrabPhase::holding, k_ship,
                       pose_at(Vec3(0.1, 1.0, 0.0)));
        scene.set_edge(leaving, GrabEdge::release, 0.5);
        scene.hand.at(leaving).resumed = true;
        scene.run();
        EXPECT_EQ(scene.grab.at(leaving).kind, GripKind::none);
        EXPECT_EQ(count_of(scene.stats, Fallback::grip_lost), 1U);
        EXPECT_LT((scene.grab.at(staying).anchor_bs.position - Vec3(0.3, 1.0, 0.0)).norm(), 1e-12);
    }
}

TEST(AnchorGrabs, HandThatLeavesABodyHeldByBothIsGoneAtOnce) {
    Anchoring scene;
    scene.move_hand(k_left, pose_at(Vec3(-0.2, 1.0, 0.0)), pose_at(Vec3(-0.2, 1.0, 0.0)));
    scene.set_grip(k_left, GripKind::held, GrabPhase::holding, k_ship,
                   pose_at(Vec3(7.0, 7.0, 7.0)));
    scene.set_grip(k_right, GripKind::held, GrabPhase::releasing, k_ship);
    scene.set_edge(k_right, GrabEdge::release, 0.5);
    scene.run();
    EXPECT_EQ(scene.grab.at(k_right).kind, GripKind::none);
    EXPECT_EQ(count_of(scene.stats, Fallback::two_hand_grip_ended), 1U);
    EXPECT_LT((scene.grab.at(k_left).anchor_bs.position - Vec3(-0.2, 1.0, 0.0)).norm(), 1e-12);
}

TEST(AnchorGrabs, HandsThatOpenInOneFrameBothThrow) {
    Anchoring scene;
    for (const Entity hand : {k_left, k_right}) {
        scene.set_grip(hand, GripKind::surface, GrabPhase::releasing, k_wall);
        scene.set_edge(hand, GrabEdge::release, 0.5);
    }
    scene.run();
    EXPECT_EQ(scene.grab.at(k_left).phase, GrabPhase::releasing);
    EXPECT_EQ(scene.grab.at(k_right).phase, GrabPhase::releasing);
    EXPECT_EQ(count_of_all(scene.stats), 0U);
}

// --- Tracking that comes back --------------------------------------------------------------------

TEST(AnchorGrabs, HandFoundAgainTakesItsAnchorWhereItIs) {
    Anchoring scene;
    scene.move_player(pose_at(Vec3(0.0, 0.0, 5.0)), pose_at(Vec3(0.0, 0.0, 5.0)));
    scene.move_hand(k_right, pose_at(Vec3(0.7, 1.0, 0.0)), pose_at(Vec3(0.7, 1.0, 0.0)));
    scene.hand.at(k_right).resumed = true;
    scene.set_grip(k_right, GripKind::surface, GrabPhase::holding, k_wall,
                   pose_at(Vec3(0.3, 1.0, 5.0)));
    scene.run();
    EXPECT_LT((scene.grab.at(k_right).anchor_bs.position - Vec3(0.7, 1.0, 5.0)).norm(), 1e-12);
    EXPECT_EQ(count_of(scene.stats, Fallback::grip_reanchored), 1U);
}

// Both controllers are tracked again in one frame, each somewhere else. Neither may pull the player
// along.
TEST(AnchorGrabs, BothHandsFoundAgainAtOnceDoNotMoveThePlayer) {
    Anchoring scene;
    const Vec3 found[2] = {Vec3(-0.9, 1.0, 0.0), Vec3(0.7, 1.4, 0.0)};
    for (const Entity hand : {k_left, k_right}) {
        const Pose pose = pose_at(found[hand == k_left ? 0 : 1]);
        scene.move_hand(hand, pose, pose);
        scene.hand.at(hand).resumed = true;
        scene.set_grip(hand, GripKind::surface, GrabPhase::holding, k_wall,
                       pose_at(Vec3(0.0, 1.0, 0.0)));
    }
    scene.run();
    EXPECT_LT((scene.grab.at(k_left).anchor_bs.position - found[0]).norm(), 1e-12);
    EXPECT_LT((scene.grab.at(k_right).anchor_bs.position - found[1]).norm(), 1e-12);
    EXPECT_EQ(count_of(scene.stats, Fallback::grip_reanchored), 2U);
}

// --- Properties ----------------------------------------------------------------------------------

// --- Tracking errors -----------------------------------------------------------------------------

// 0.5 m in 10 ms at 8 m/s at most: the grip slips by 0.42 m, so that the player moves 0.08 m.
TEST(AnchorGrabs, HandFasterThanAHandSlipsByTheRest) {
    for (const GripKind kind : {GripKind::surface, GripKind::held}) {
        Anchoring scene;
        scene.tuning.tracking.max_hand_speed_mps = 8.0;
        scene.tuning.hand.return_speed_mps = 0.0;
        scene.move_hand(k_right, pose_at(Vec3(0.3, 1.0, 0.0)), pose_at(Vec3(0.3, 1.5, 0.0)));
        scene.set_grip(k_right, kind, GrabPhase::holding, k_wall, pose_at(Vec3(0.3, 1.0, 0.0)));
        scene.run();
        const Grab& grab = scene.grab.at(k_right);
        EXPECT_LT((grab.anchor_bs.position - Vec3(0.3, 1.42, 0.0)).norm(), 1e-12);
        EXPECT_EQ(grab.target_ps.position, Vec3(0.3, 1.5, 0.0));
        EXPECT_LT((grab.slip_hs.position - Vec3(0.0, -0.42, 0.0)).norm(), 1e-12);
        EXPECT_EQ(count_of(scene.stats, Fallback::grip_speed_limited), 1U);
    }
}

// A slip of 0.42 m at 2 m/s: 20 mm in a frame of 10 ms. A surface stays where it is.
TEST(AnchorGrabs, HeldBodyReturnsByItsSlip) {
    for (const GripKind kind : {GripKind::surface, GripKind::held}) {
        Anchoring scene;
        scene.move_hand(k_right, pose_at(Vec3(0.3, 1.5, 0.0)), pose_at(Vec3(0.3, 1.5, 0.0)));
        scene.set_grip(k_right, kind, GrabPhase::holding, k_wall, pose_at(Vec3(0.3, 1.42, 0.0)));
        scene.grab.at(k_right).slip_hs.position = Vec3(0.0, -0.42, 0.0);
        scene.run();
        const double moved_m = kind == GripKind::held ? 0.02 : 0.0;
        const Grab& grab = scene.grab.at(k_right);
        EXPECT_LT((grab.anchor_bs.position - Vec3(0.3, 1.42 - moved_m, 0.0)).norm(), 1e-12);
        EXPECT_LT((grab.slip_hs.position - Vec3(0.0, moved_m - 0.42, 0.0)).norm(), 1e-12);
    }
}

// However often it slips: what the slip undoes is the first anchor.
RC_GTEST_PROP(AnchorGrabs, SlipKeepsTheFirstAnchor, (std::uint64_t seed)) {
    Random random(seed);
    Anchoring scene;
    const Pose first = random.pose();
    scene.set_grip(k_right, GripKind::held, GrabPhase::holding, k_wall, first);
    for (int jump = 0; jump < 5; ++jump) {
        const Pose hand = random.pose();
        scene.move_hand(k_right, hand, hand);
        scene.hand.at(k_right).resumed = random.between(0.0, 1.0) < 0.7;
        scene.run();
        const Grab& grab = scene.grab.at(k_right);
        RC_ASSERT(distance(grab.anchor_bs * grab.slip_hs, first) < 1e-7);
    }
}

}  // namespace
}  // namespace handhold::anchor_grabs_test

// Hands that hold one body together: of one player, then of two.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "systems/grab/anchor_grabs.hpp"
#include "tests/systems/grab/anchoring.hpp"

namespace handhold::anchor_grabs_test {
namespace {

using test::count_of;
using test::count_of_all;
using test::distance;
using test::pose_at;
// Hands 40 cm apart on one body, both on their anchors at the frame's start.
Anchoring held_by_both(bool two_handed) {
    Anchoring scene;
    for (const Entity hand : {k_left, k_right}) {
        const Pose pose = pose_at(Vec3(hand == k_left ? -0.2 : 0.2, 1.0, 0.0));
        scene.move_hand(hand, pose, pose);
        scene.set_grip(hand, GripKind::held, GrabPhase::holding, k_ship, pose);
        scene.grab.at(hand).since_s = hand == k_left ? 0.5 : 1.0;
        scene.grab.at(hand).two_handed = two_handed;
    }
    return scene;
}

TEST(AnchorGrabs, TwoHandsLeadABodyTogetherWhereTheyAreApart) {
    for (const bool before : {false, true}) {
        for (const double apart_m : {0.03, 0.045, 0.06}) {
            Anchoring scene = held_by_both(before);
            const Pose near = pose_at(Vec3(-0.2 + apart_m, 1.0, 0.0));
            scene.move_hand(k_right, near, near);
            scene.run();
            // Both hands together hold from 5 cm apart on, and until they are 4 cm apart.
            const bool together = apart_m > (before ? 0.04 : 0.05);
            EXPECT_EQ(scene.grab.at(k_left).two_handed, together);
            EXPECT_EQ(scene.grab.at(k_right).two_handed, together);
            EXPECT_EQ(count_of(scene.stats, Fallback::hands_too_close), together ? 0U : 1U);
            // Hands that already held together keep their anchors, and the second slides. Otherwise
            // the second is anchored where it is.
            const double anchor_x = before && together ? 0.2 : -0.2 + apart_m;
            EXPECT_NEAR(scene.grab.at(k_right).anchor_bs.position.x(), anchor_x, 1e-12);
            EXPECT_NEAR(scene.grab.at(k_left).anchor_bs.position.x(), -0.2, 1e-12);
        }
    }
}

TEST(AnchorGrabs, HandWhosePartnerIsGoneStartsAfreshWhereItWas) {
    for (const Entity gone : {k_left, k_right}) {
        Anchoring scene = held_by_both(true);
        const Entity staying = other_of(gone);
        scene.grab.at(gone) = {};  // stretched too far
        scene.move_hand(staying, pose_at(Vec3(0.1, 1.2, 0.3)), pose_at(Vec3(0.1, 1.2, 0.4)));
        scene.run();
        EXPECT_FALSE(scene.grab.at(staying).two_handed);
        EXPECT_LT((scene.grab.at(staying).anchor_bs.position - Vec3(0.1, 1.2, 0.3)).norm(), 1e-12);
        EXPECT_EQ(count_of(scene.stats, Fallback::grip_reanchored), 1U);
    }
}

TEST(AnchorGrabs, HandsOnWhatHangsOnJointsDoNotLeadTogether) {
    Anchoring scene = held_by_both(false);
    for (const Entity hand : {k_left, k_right}) {
        scene.grab.at(hand).jointed = true;
    }
    scene.run();
    EXPECT_FALSE(scene.grab.at(k_left).two_handed);
    EXPECT_EQ(count_of_all(scene.stats), 0U);
}

// The body follows the hand that holds it, not its predicted velocity. A second hand's anchor is
// where the body is then.
TEST(AnchorGrabs, SecondHandsAnchorGoesByTheHandThatHoldsTheBody) {
    Anchoring scene = held_by_both(false);
    scene.move_hand(k_left, pose_at(Vec3(-0.2, 1.0, 0.0)), pose_at(Vec3(-0.2, 1.0, 0.2)));
    scene.move_body(k_ship, {}, pose_at(Vec3(0.0, 0.0, 7.0)));
    scene.grab.at(k_right).phase = GrabPhase::fresh;
    scene.set_edge(k_right, GrabEdge::onset, 0.5);
    scene.run();
    EXPECT_LT((scene.grab.at(k_right).anchor_bs.position - Vec3(0.2, 1.0, -0.1)).norm(), 1e-12);
}

// --- Hands of two players ------------------------------------------------------------------------

constexpr Entity k_guest = test::entity(7);
constexpr Entity k_guest_hand = test::entity(8);

// The first player's left hand holds the ship at its pose of the frame's start, and moves by 0.2 m
// along z. By prediction alone the ship would fly off. A guest's hand closes on it.
Anchoring joined_by_guest(double fraction, bool guest_is_listed_first) {
    Anchoring scene({});
    scene.player_start.add(k_guest);
    scene.origin.add(k_guest);
    if (guest_is_listed_first) {
        scene.add_hand(k_guest, k_guest_hand, HandSide::right);
        scene.add_hand(k_player, k_left, HandSide::left);
    } else {
        scene.add_hand(k_player, k_left, HandSide::left);
        scene.add_hand(k_guest, k_guest_hand, HandSide::right);
    }
    scene.move_body(k_ship, {}, pose_at(Vec3(0.0, 0.0, 7.0)));
    scene.move_hand(k_left, pose_at(Vec3(-0.2, 1.0, 0.0)), pose_at(Vec3(-0.2, 1.0, 0.2)));
    scene.move_hand(k_guest_hand, pose_at(Vec3(0.2, 1.0, 0.0)), pose_at(Vec3(0.2, 1.0, 0.0)));
    scene.set_grip(k_left, GripKind::held, GrabPhase::holding, k_ship,
                   pose_at(Vec3(-0.2, 1.0, 0.0)));
    scene.set_grip(k_guest_hand, GripKind::held, GrabPhase::fresh, k_ship);
    scene.set_edge(k_guest_hand, GrabEdge::onset, fraction);
    return scene;
}
Vec3 guest_anchor(Anchoring scene) {
    scene.run();
    return scene.grab.at(k_guest_hand).anchor_bs.position;
}

TEST(AnchorGrabs, GuestsAnchorGoesByTheHandThatHoldsTheBodyWhoeverIsListedFirst) {
    for (const bool first : {false, true}) {
        EXPECT_LT((guest_anchor(joined_by_guest(0.5, first)) - Vec3(0.2, 1.0, -0.1)).norm(), 1e-12);
        EXPECT_LT((guest_anchor(joined_by_guest(1.0, first)) - Vec3(0.2, 1.0, -0.2)).norm(), 1e-12);
    }
}

// Both players' hands close in this frame. The first player's closes after a quarter of it, where
// the ship is predicted to be; from then on the ship follows that hand. A hand that closes later
// than the guest's, or at the same time, has no effect on the guest's anchor.
TEST(AnchorGrabs, WhoClosesFirstLeadsWhoeverIsListedFirst) {
    for (const bool first : {false, true}) {
        const auto closing_at = [&](double fraction) {
            Anchoring scene = joined_by_guest(0.5, first);
            scene.grab.at(k_left).phase = GrabPhase::fresh;
            scene.set_edge(k_left, GrabEdge::onset, fraction);
            return guest_anchor(scene);
        };
        const double ship_z = 0.25 * 7.0 + 0.25 * 0.2;
        EXPECT_LT((closing_at(0.25) - Vec3(0.2, 1.0, -ship_z)).norm(), 1e-12);
        EXPECT_LT((closing_at(0.5) - Vec3(0.2, 1.0, -3.5)).norm(), 1e-12);
        EXPECT_LT((closing_at(0.75) - Vec3(0.2, 1.0, -3.5)).norm(), 1e-12);
    }
}

// The first player climbs with the other hand: the body that they hold moves with the wall, not
// with their predicted motion.
TEST(AnchorGrabs, GuestsAnchorGoesByTheWallThatTheHolderHoldsOnTo) {
    Anchoring scene = joined_by_guest(0.5, false);
    scene.add_hand(k_player, k_right, HandSide::right);
    scene.set_grip(k_right, GripKind::surface, GrabPhase::holding, k_wall, pose_at(Vec3(0, 2, 0)));
    scene.move_hand(k_right, pose_at(Vec3(0, 2, 0)), pose_at(Vec3(0.0, 2.3, 0.0)));  // moves down
    scene.move_player({}, pose_at(Vec3(5.0, 0.0, 0.0)));
    EXPECT_LT((guest_anchor(scene) - Vec3(0.2, 1.15, -0.1)).norm(), 1e-12);
}

// Two players hold the body already. Only the solver finds its motion, so the anchor is where
// prediction puts it.
TEST(AnchorGrabs, BodyInTheHandsOfTwoOthersIsWherePredictionHasIt) {
    constexpr Entity k_third = test::entity(9);
    constexpr Entity k_third_hand = test::entity(10);
    Anchoring scene = joined_by_guest(0.5, false);
    scene.player_start.add(k_third);
    scene.origin.add(k_third);
    scene.add_hand(k_third, k_third_hand, HandSide::left);
    scene.set_grip(k_third_hand, GripKind::held, GrabPhase::holding, k_ship);
    EXPECT_LT((guest_anchor(scene) - Vec3(0.2, 1.0, -3.5)).norm(), 1e-12);
}

// A hand closes on the head of a climber who holds a wall. Its anchor uses the place to which the
// climber's own gripping hand moves him, not his simulated pose.
TEST(AnchorGrabs, AnchorOnAClimbersHeadGoesByTheWallThatHeHoldsOnTo) {
    Anchoring scene = joined_by_guest(0.5, false);
    scene.head.add(k_player);
    scene.set_grip(k_left, GripKind::surface, GrabPhase::holding, k_wall,
                   pose_at(Vec3(-0.2, 1.0, 0.0)));  // the climber moves back by 0.2 m
    scene.move_player({}, pose_at(Vec3(5.0, 0.0, 0.0)));
    scene.set_grip(k_guest_hand, GripKind::player, GrabPhase::fresh, k_player);
    EXPECT_LT((guest_anchor(scene) - Vec3(0.2, 1.0, 0.1)).norm(), 1e-12);
}

TEST(AnchorGrabs, HandsOnDifferentFreeBodiesLeaveEachOtherAlone) {
    Anchoring scene;
    const Pose anchor = pose_at(Vec3(0.1, 0.0, 0.0));
    scene.set_grip(k_left, GripKind::held, GrabPhase::holding, k_wall, anchor);
    scene.set_grip(k_right, GripKind::held, GrabPhase::releasing, k_ship);
    scene.set_edge(k_right, GrabEdge::release, 0.5);
    scene.run();
    EXPECT_EQ(scene.grab.at(k_right).phase, GrabPhase::releasing);
    EXPECT_EQ(scene.grab.at(k_left).anchor_bs.position, anchor.position);
    EXPECT_EQ(count_of_all(scene.stats), 0U);
}

}  // namespace
}  // namespace handhold::anchor_grabs_test

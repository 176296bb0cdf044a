// Talk row 10: fitting a hand to an authored grip.
#include "components/authored_grip.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "fitted_hand.hpp"
#include "systems/hand/shared/finger_chain.hpp"

namespace handhold::authored_grip_test {
namespace {

using test::count_of;
using test::distance;
using test::FittedHand;
using test::k_unlimited_s;
using test::wrist_with_palm_at;

struct AuthoredGripOnFloor : testing::Test {
    GripMesh floor = build_grip_mesh(test::make_floor_mesh());
    const HandRig rig = builtin_hand_rig(HandSide::right);
    const Pose closed = wrist_with_palm_at(rig, {0.02, 0.05, 0.03}, Vec3::UnitY());
    AuthoredHand grip;

    AuthoredGripOnFloor() {
        grip.is_there = true;
        grip.wrist_bs = wrist_with_palm_at(rig, {0.0, 0.03, 0.0}, Vec3(0.1, 1.0, 0.0).normalized());
        for (std::size_t f = 0; f < k_finger_count; ++f) {
            grip.is_posed[f] = true;
            grip.fingers[f].curl_rad = {0.1, 0.15, 0.05};
        }
        grip.fingers[0].opposition_rad = -1.0;
    }
};

TEST_F(AuthoredGripOnFloor, PalmMovesToAuthoredPoseAtPalmRate) {
    FittedHand hand(floor, closed);
    hand.hands.front().authored = &grip;
    const double dt_s = 1.0 / 90.0;
    Pose before = closed;
    double travel_m = 0.0;
    for (int frame = 0; frame < 90; ++frame) {
        hand.frame(dt_s);
        const double step_m = (hand.shown_bs().position - before.position).norm();
        EXPECT_LE(step_m, hand.tuning.palm.rate_mps * dt_s + 1e-9);
        travel_m += step_m;
        before = hand.shown_bs();
    }
    EXPECT_LT(distance(hand.shown_bs(), grip.wrist_bs), 1e-9);
    EXPECT_GT(travel_m, 0.9 * (grip.wrist_bs.position - closed.position).norm());
    // After leaving the grip the palm is fitted to the surface again.
    hand.hands.front().authored = nullptr;
    hand.frame(k_unlimited_s);
    EXPECT_GT(distance(hand.shown_bs(), grip.wrist_bs), 0.01);
}

TEST_F(AuthoredGripOnFloor, FingersTakeAuthoredPoseAtClosingRate) {
    FittedHand hand(floor, grip.wrist_bs);
    hand.hands.front().authored = &grip;
    hand.tuning.finger.close_radps = 1.0;
    hand.frame(0.01);
    for (std::size_t f = 0; f < rig.fingers.size(); ++f) {
        EXPECT_EQ(hand.pose().target[f].curl_rad, grip.fingers[f].curl_rad) << f;
        EXPECT_LE(hand.pose().shown[f].curl_rad[1], 0.01 + 1e-12) << f;
    }
    hand.frame(k_unlimited_s);
    EXPECT_EQ(hand.pose().shown[0].opposition_rad, -1.0);
    EXPECT_EQ(hand.pose().shown[2].curl_rad, grip.fingers[2].curl_rad);
    EXPECT_EQ(count_of(hand.stats, Fallback::authored_finger_rejected), 0U);
}

// Expected: linear between the two authored poses, in the frame of the reading.
TEST_F(AuthoredGripOnFloor, TriggerFingerFollowsTriggerAndOthersStay) {
    grip.follows_trigger[1] = true;
    grip.pressed[1].curl_rad = {0.2, 0.9, 0.6};
    FittedHand hand(floor, grip.wrist_bs);
    hand.hands.front().authored = &grip;
    hand.tracking.at(test::k_right).pressed = true;
    for (const double trigger : {0.0, 0.25, 1.0, 0.5, 0.0}) {
        hand.tracking.at(test::k_right).trigger = trigger;
        hand.frame(k_unlimited_s);
        for (std::size_t f = 0; f < rig.fingers.size(); ++f) {
            for (std::size_t i = 0; i < k_max_links; ++i) {
                const double open_rad = grip.fingers[f].curl_rad[i];
                const double wanted_rad =
                    f == 1 ? open_rad + trigger * (grip.pressed[1].curl_rad[i] - open_rad)
                           : open_rad;
                EXPECT_NEAR(hand.pose().shown[f].curl_rad[i], wanted_rad, 1e-12) << f;
            }
        }
    }
    EXPECT_EQ(count_of(hand.stats, Fallback::authored_finger_rejected), 0U);
}

TEST_F(AuthoredGripOnFloor, RejectedFingerDoesNotFollowTrigger) {
    grip.fingers[1].curl_rad = {1.2, 0.3, 0.1};  // through the floor
    grip.follows_trigger[1] = true;
    grip.pressed[1].curl_rad = {1.4, 0.9, 0.6};
    FittedHand hand(floor, grip.wrist_bs);
    hand.hands.front().authored = &grip;
    hand.tracking.at(test::k_right).trigger = 1.0;
    hand.frame(k_unlimited_s);
    EXPECT_EQ(count_of(hand.stats, Fallback::authored_finger_rejected), 1U);
    const HingeChain chain = finger_chain(rig.fingers[1], 0.0, hand.shown_bs());
    for (const Capsule& capsule : chain_capsules(chain, hand.pose().shown[1].curl_rad)) {
        EXPECT_LT(find_penetration(capsule, hand.hands.front().meshes).depth_m, 1.5e-3);
    }
}

// Fingers without an authored pose: as close to the floor as without the pointing index finger, and
// where they are whatever the trigger does. Expected: the distance to the plane y = 0.
TEST_F(AuthoredGripOnFloor, PosedIndexFingerLeavesOtherFingersOnTheSurface) {
    const auto gap_of_middle_m = [&](bool points, double trigger) {
        AuthoredHand pointing;
        pointing.is_there = true;
        pointing.wrist_bs = grip.wrist_bs;
        pointing.is_posed[1] = points;
        pointing.fingers[1].curl_rad = {0.0, 0.0, 0.0};
        pointing.follows_trigger[1] = true;
        pointing.pressed[1].curl_rad = {0.1, 0.5, 0.4};
        FittedHand hand(floor, grip.wrist_bs);
        hand.hands.front().authored = &pointing;
        hand.tracking.at(test::k_right).trigger = trigger;
        for (int frame = 0; frame < 30; ++frame) {
            hand.frame(k_unlimited_s);
            hand.wrist_bs().position.x() += 1e-4;  // the fit goes on
        }
        const HingeChain chain = finger_chain(rig.fingers[2], 0.0, hand.shown_bs());
        double gap_m = 1.0;
        for (const Capsule& capsule : chain_capsules(chain, hand.pose().shown[2].curl_rad)) {
            gap_m = std::min({gap_m, capsule.ends[0].y() - capsule.radius_m,
                              capsule.ends[1].y() - capsule.radius_m});
        }
        return gap_m;
    };
    const double alone_m = gap_of_middle_m(false, 0.0);
    EXPECT_NEAR(gap_of_middle_m(true, 0.0), alone_m, 1e-3);
    EXPECT_EQ(gap_of_middle_m(true, 1.0), gap_of_middle_m(true, 0.0));
}

// Oracle: find_penetration, which has its own tests.
TEST_F(AuthoredGripOnFloor, PenetratingAuthoredFingerIsFittedAndCounted) {
    grip.fingers[1].curl_rad = {1.2, 0.3, 0.1};  // through the floor
    FittedHand hand(floor, grip.wrist_bs);
    hand.hands.front().authored = &grip;
    hand.frame(k_unlimited_s);
    EXPECT_EQ(count_of(hand.stats, Fallback::authored_finger_rejected), 1U);
    const HingeChain chain = finger_chain(rig.fingers[1], 0.0, hand.shown_bs());
    for (const Capsule& capsule : chain_capsules(chain, hand.pose().target[1].curl_rad)) {
        EXPECT_LT(find_penetration(capsule, hand.hands.front().meshes).depth_m, 1.5e-3);
    }
    EXPECT_EQ(hand.pose().target[2].curl_rad, grip.fingers[2].curl_rad);
}

// The palm rises from the floor, where its authored fingers penetrate, to 3 cm above it, where they
// are just clear.
struct AuthoredGripRisingPalm : AuthoredGripOnFloor {
    const Pose low = wrist_with_palm_at(rig, {0.0, 0.004, 0.0}, Vec3::UnitY());
    const double dt_s = 1.0 / 90.0;

    AuthoredGripRisingPalm() {
        grip.wrist_bs = wrist_with_palm_at(rig, {0.0, 0.03, 0.0}, Vec3::UnitY());
        for (const std::size_t f : {0U, 1U}) {
            while (depth_m(f) == 0.0 && turn_rad(f) < 1.5) {
                turn_rad(f) += 0.01;
            }
            turn_rad(f) -= 0.02;
        }
    }
    // The angle that turns the finger towards the floor.
    double& turn_rad(std::size_t f) {
        return f == 0 ? grip.fingers[f].opposition_rad : grip.fingers[f].curl_rad[0];
    }
    double depth_m(std::size_t f) {
        const HingeChain chain =
            finger_chain(rig.fingers[f], grip.fingers[f].opposition_rad, grip.wrist_bs);
        const std::vector<PlacedMesh> meshes = {{&floor, {}}};
        double deepest_m = 0.0;
        for (const Capsule& capsule : chain_capsules(chain, grip.fingers[f].curl_rad)) {
            deepest_m = std::max(deepest_m, find_penetration(capsule, meshes).depth_m);
        }
        return deepest_m;
    }
};

TEST_F(AuthoredGripRisingPalm, FingersTakeAuthoredPoseIfClearAtTheEnd) {
    for (const double reuse_travel_m : {1e-6, 0.01}) {
        FittedHand hand(floor, low);
        hand.tuning.finger.reuse_travel_m = reuse_travel_m;
        hand.hands.front().authored = &grip;
        for (const std::size_t f : {0U, 1U}) {
            ASSERT_LT(turn_rad(f), 1.4) << "finger " << f << " misses the floor";
        }
        for (int frame = 0; frame < 60; ++frame) {
            hand.frame(dt_s);
        }
        EXPECT_LT(distance(hand.shown_bs(), grip.wrist_bs), 1e-9);
        for (std::size_t f = 0; f < rig.fingers.size(); ++f) {
            EXPECT_EQ(hand.pose().target[f].curl_rad, grip.fingers[f].curl_rad)
                << "finger " << f << " reuse_travel_m " << reuse_travel_m;
        }
        EXPECT_EQ(count_of(hand.stats, Fallback::authored_finger_rejected), 0U);
    }
}

TEST_F(AuthoredGripRisingPalm, PenetratingFingersAreCountedOnce) {
    for (const std::size_t f : {0U, 1U}) {
        turn_rad(f) += 0.3;
    }
    for (const double reuse_travel_m : {1e-6, 0.01}) {
        FittedHand hand(floor, low);
        hand.tuning.finger.reuse_travel_m = reuse_travel_m;
        hand.tuning.finger.close_radps = 0.5;  // slow
        hand.hands.front().authored = &grip;
        for (int frame = 0; frame < 90; ++frame) {
            hand.frame(dt_s);
        }
        EXPECT_EQ(count_of(hand.stats, Fallback::authored_finger_rejected), 2U);
    }
}

TEST_F(AuthoredGripOnFloor, FingersWithoutAuthoredPoseCloseOnSurface) {
    grip.is_posed.fill(false);
    FittedHand hand(floor, grip.wrist_bs);
    hand.hands.front().authored = &grip;
    hand.frame(k_unlimited_s);
    for (std::size_t f = 1; f < rig.fingers.size(); ++f) {
        EXPECT_GE(hand.traces[0][f].contact_link, 0) << f;
    }
}

}  // namespace
}  // namespace handhold::authored_grip_test

#include "systems/hand/sweep_fingers.hpp"

#include <gtest/gtest.h>

#include "beam.hpp"

namespace handhold::sweep_fingers_test {
namespace {

using test::FittedHand;
using test::Random;
using test::wrist_with_palm_at;

struct SweepFingers : testing::Test {
    GripMesh beam = build_grip_mesh(test::make_beam());
    const HandRig rig = builtin_hand_rig(HandSide::right);
    // The palm just behind the beam's top, the fingers above it.
    const Pose on_beam = wrist_with_palm_at(rig, {0.003, 0.012, 0.004}, Vec3::UnitY());

    static void close(FittedHand& hand) {
        hand.traces[0] = {};
        hand.search();
        hand.constrain();
        hand.sweep();
    }
    static bool closes(const FittedHand& hand) {
        return std::any_of(hand.traces[0].begin(), hand.traces[0].end(),
                           [](const FingerTrace& trace) { return trace.discs > 0; });
    }
};

TEST_F(SweepFingers, ClosesAroundBeamWithoutPenetration) {
    FittedHand hand(beam, on_beam);
    close(hand);
    EXPECT_LT(test::deepest_digit_m(hand, hand.pose().closed, hand.shown_bs()), 1.5e-3);
    int touching = 0;
    for (std::size_t f = 0; f < rig.fingers.size(); ++f) {
        touching += hand.pose().touches[f] ? 1 : 0;
    }
    EXPECT_GE(touching, 4);
}

TEST_F(SweepFingers, ClosingDoesNotDependOnBodyPose) {
    Random random(2301);
    FittedHand at_origin(beam, on_beam);
    close(at_origin);
    for (int i = 0; i < 10; ++i) {
        FittedHand elsewhere(beam, on_beam);
        elsewhere.hands.front().body_ws = random.pose(20.0);
        close(elsewhere);
        for (std::size_t f = 0; f < rig.fingers.size(); ++f) {
            EXPECT_EQ(elsewhere.pose().closed[f].curl_rad, at_origin.pose().closed[f].curl_rad);
        }
    }
}

TEST_F(SweepFingers, LeftHandMirrorsRightHand) {
    // The beam is symmetric about the plane x = 0, except for its triangles' diagonals.
    FittedHand right(beam, on_beam);
    FittedHand left(beam, test::mirrored(on_beam), HandSide::left);
    close(right);
    close(left);
    for (std::size_t f = 0; f < rig.fingers.size(); ++f) {
        for (std::size_t k = 0; k < k_max_links; ++k) {
            EXPECT_NEAR(left.pose().closed[f].curl_rad[k], right.pose().closed[f].curl_rad[k], 0.01)
                << "finger " << f;
        }
    }
}

TEST_F(SweepFingers, ThumbAnglesStayWithinLimits) {
    Random random(2302);
    const FingerRig& thumb = rig.fingers[0];
    ASSERT_EQ(thumb.name, FingerName::thumb);
    int touching = 0;
    for (int i = 0; i < 40; ++i) {
        const Vec3 up = (Vec3::UnitY() + random.vector(0.4)).normalized();
        FittedHand hand(beam,
                        wrist_with_palm_at(rig, Vec3(0.0, 0.01, 0.0) + random.vector(0.015), up));
        close(hand);
        const FingerAngles& angles = hand.pose().closed[0];
        EXPECT_GE(angles.opposition_rad, thumb.lower_opposition_rad);
        EXPECT_LE(angles.opposition_rad, thumb.upper_opposition_rad);
        for (std::size_t k = 0; k < thumb.link_count; ++k) {
            EXPECT_GE(angles.curl_rad[k], thumb.lower_rad[k] - 1e-12);
            EXPECT_LE(angles.curl_rad[k], thumb.upper_rad[k] + 1e-12);
        }
        touching += hand.pose().touches[0] ? 1 : 0;
    }
    EXPECT_GT(touching, 20);
}

TEST_F(SweepFingers, ClosesAgainOnlyFarAwayOrElsewhere) {
    FittedHand hand(beam, on_beam);
    close(hand);
    EXPECT_TRUE(closes(hand));
    hand.wrist_bs().rotation =
        (hand.wrist_bs().rotation * rotation_about(Vec3::UnitY(), 0.1)).normalized();
    close(hand);
    EXPECT_FALSE(closes(hand)) << "turned a little";
    hand.wrist_bs().position.x() += 0.1;
    close(hand);
    EXPECT_TRUE(closes(hand)) << "moved along";
    hand.hands.front().body = test::entity(4);
    close(hand);
    EXPECT_TRUE(closes(hand)) << "another body";
}

TEST_F(SweepFingers, EmptyHandForgetsWhatItClosedFor) {
    FittedHand hand(beam, on_beam);
    close(hand);
    const auto meshes = hand.hands.front().meshes;
    hand.hands.front().meshes.clear();
    close(hand);
    EXPECT_FALSE(closes(hand));
    hand.hands.front().meshes = meshes;
    close(hand);
    EXPECT_TRUE(closes(hand));
}

}  // namespace
}  // namespace handhold::sweep_fingers_test

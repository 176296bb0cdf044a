#include "systems/hand/sweep_fingers.hpp"

#include <gtest/gtest.h>

#include "engine/geometry/chain_refit.hpp"
#include "hand_on_beam.hpp"
#include "systems/hand/shared/finger_chain.hpp"

namespace handhold::sweep_fingers_test {
namespace {

TEST_F(SweepFingers, ClosesAroundBeamWithoutPenetration) {
    FittedHand hand(beam, on_beam);
    hand.frame(k_unbudgeted_s);
    EXPECT_LT(deepest_m(hand), 1.5e-3);
    int touching = 0;
    for (std::size_t f = 0; f < rig.fingers.size(); ++f) {
        touching += hand.traces[0][f].contact_link >= 0 ? 1 : 0;
    }
    EXPECT_GE(touching, 4);
}

TEST_F(SweepFingers, OpensAtOnceAndClosesAtLimitedRate) {
    FittedHand hand(beam, on_beam);
    hand.tuning.finger.close_radps = 2.0;
    const double step_rad = 2.0 * k_dt_s;
    FingerPose before = hand.pose();
    for (int frame = 0; frame < 120; ++frame) {
        hand.frame(k_dt_s);
        const FingerPose& now = hand.pose();
        for (std::size_t f = 0; f < rig.fingers.size(); ++f) {
            for (std::size_t i = 0; i < rig.fingers[f].link_count; ++i) {
                const double shown = now.shown[f].curl_rad[i];
                EXPECT_LE(shown, now.target[f].curl_rad[i]);
                EXPECT_LE(shown, before.shown[f].curl_rad[i] + step_rad + 1e-12);
            }
        }
        before = now;
    }
    // At the target. Then the hand lets go, and hinges that open reach the rest pose in one frame.
    EXPECT_EQ(before.shown[2].curl_rad, before.target[2].curl_rad);
    hand.hands.front().body = k_no_entity;
    hand.hands.front().is_gripping = false;
    hand.hands.front().meshes.clear();
    hand.tracking.at(k_right).pressed = false;
    hand.frame(k_dt_s);
    for (std::size_t f = 0; f < rig.fingers.size(); ++f) {
        for (std::size_t i = 0; i < rig.fingers[f].link_count; ++i) {
            EXPECT_LE(hand.pose().shown[f].curl_rad[i], rig.fingers[f].rest_rad[i] + 1e-12);
        }
    }
}

// A hand slides back and forth across a beam's edge while turning, so that penetrating fingers
// change between fits under and above the beam. Following a surface opens a hinge by at most a
// share of its range per frame; a change of fit adds at most the transition rate.
TEST_F(SweepFingers, ChangeOfFitIsShownAtTransitionRate) {
    const ChainRefitSettings refit;
    double range_rad = 0.0;
    for (const FingerRig& finger : rig.fingers) {
        for (std::size_t i = 0; i < finger.link_count; ++i) {
            range_rad = std::max(range_rad, finger.upper_rad[i] - finger.lower_rad[i]);
        }
    }
    const double followed_rad = refit.open_share * refit.open_steps * range_rad;
    const auto max_opening_rad = [&](double transition_radps) {
        FittedHand hand(beam, on_beam);
        hand.tuning.finger.transition_radps = transition_radps;
        hand.frame(k_unbudgeted_s);
        double max_rad = 0.0;
        for (int frame = 0; frame < 540; ++frame) {
            const FingerPose before = hand.pose();
            const double turn = 2.0 * M_PI * frame / 180.0;
            const Quat yaw = rotation_about(Vec3::UnitY(), 0.6 * std::sin(0.7 * turn));
            hand.wrist_bs() =
                on_beam * Pose{Vec3(0.01 * std::sin(0.3 * turn), 0.0, 0.06 * std::sin(turn)), yaw};
            hand.frame(k_dt_s);
            for (std::size_t f = 0; f < rig.fingers.size(); ++f) {
                for (std::size_t i = 0; i < rig.fingers[f].link_count; ++i) {
                    max_rad = std::max(
                        max_rad, before.shown[f].curl_rad[i] - hand.pose().shown[f].curl_rad[i]);
                }
            }
        }
        return max_rad;
    };
    const double transition_radps = FingerTuning{}.transition_radps;
    EXPECT_LE(max_opening_rad(transition_radps), transition_radps * k_dt_s + followed_rad);
    EXPECT_GT(max_opening_rad(1e6), 2.0 * (transition_radps * k_dt_s + followed_rad));
}

TEST_F(SweepFingers, EmptyHandTakesRestPoseOrFist) {
    FittedHand hand(beam, {});
    hand.hands.front().body = k_no_entity;
    hand.hands.front().is_gripping = false;
    hand.hands.front().meshes.clear();
    hand.tracking.at(k_right).pressed = false;
    hand.frame(k_unbudgeted_s);
    const FingerPose rest = hand.pose();
    hand.tracking.at(k_right).pressed = true;
    hand.frame(k_unbudgeted_s);
    for (std::size_t f = 1; f < rig.fingers.size(); ++f) {
        EXPECT_EQ(rest.shown[f].curl_rad, rig.fingers[f].rest_rad);
        for (std::size_t i = 0; i < rig.fingers[f].link_count; ++i) {
            EXPECT_GT(hand.pose().shown[f].curl_rad[i], rest.shown[f].curl_rad[i]);
            EXPECT_LE(hand.pose().shown[f].curl_rad[i], rig.fingers[f].upper_rad[i]);
        }
    }
}

TEST_F(SweepFingers, PoseDoesNotDependOnBodyPose) {
    Random random(2301);
    FittedHand at_origin(beam, on_beam);
    at_origin.frame(k_unbudgeted_s);
    for (int i = 0; i < 10; ++i) {
        FittedHand elsewhere(beam, on_beam);
        elsewhere.hands.front().body_ws = random.pose(20.0);
        elsewhere.frame(k_unbudgeted_s);
        EXPECT_LT((elsewhere.shown_bs().position - at_origin.shown_bs().position).norm(), 1e-9);
        for (std::size_t f = 0; f < rig.fingers.size(); ++f) {
            // 0.25 mm at a fingertip: rounding decides which corners a walk leaves out.
            for (std::size_t k = 0; k < k_max_links; ++k) {
                EXPECT_NEAR(elsewhere.pose().target[f].curl_rad[k],
                            at_origin.pose().target[f].curl_rad[k], 0.01)
                    << "finger " << f;
            }
        }
    }
}

TEST_F(SweepFingers, LeftHandMirrorsRightHand) {
    // The beam is symmetric about the plane x = 0, except for its triangles' diagonals.
    const Pose wrist = on_beam;
    FittedHand right(beam, wrist);
    FittedHand left(beam, test::mirrored(wrist), HandSide::left);
    right.frame(k_unbudgeted_s);
    left.frame(k_unbudgeted_s);
    EXPECT_LT((test::mirrored(left.shown_bs()).position - right.shown_bs().position).norm(), 1e-6);
    for (std::size_t f = 0; f < rig.fingers.size(); ++f) {
        for (std::size_t k = 0; k < k_max_links; ++k) {
            EXPECT_NEAR(left.pose().target[f].curl_rad[k], right.pose().target[f].curl_rad[k], 0.01)
                << "finger " << f;
        }
    }
}

TEST_F(SweepFingers, PenetratingFingersRaisePalmStepByStep) {
    FittedHand hand(beam, on_beam);
    hand.tuning.palm.lift_from_depth_m = -1.0;  // every hand counts as penetrating
    double before_m = 0.0;
    for (int frame = 0; frame < 6; ++frame) {
        hand.frame(k_unbudgeted_s);
        const double lift_m = hand.offset.at(k_right).lift_m;
        EXPECT_GE(lift_m, before_m);
        EXPECT_LE(lift_m, 3.0 * hand.tuning.palm.lift_m + 1e-12);
        before_m = lift_m;
    }
    EXPECT_NEAR(before_m, 3.0 * hand.tuning.palm.lift_m, 1e-12);
    EXPECT_EQ(test::count_of(hand.stats, Fallback::palm_lifted), 3U);
}

// Fingers that are too shallow for a refit still raise the palm if lift_from_depth_m is small.
TEST_F(SweepFingers, ShallowPenetrationRaisesPalmIfTuned) {
    FittedHand hand(beam, on_beam);
    hand.tuning.finger.search_depth_m = 0.1;
    hand.frame(k_unbudgeted_s);
    for (int frame = 0; frame < 180; ++frame) {
        if (frame == 60) {  // long after the first fits
            ASSERT_EQ(hand.offset.at(k_right).lift_m, 0.0);
            hand.tuning.palm.lift_from_depth_m = 1e-6;
        }
        hand.wrist_bs() =
            on_beam * Pose{Vec3(0.0, 0.0, 0.01 * std::sin(0.05 * frame)), Quat::Identity()};
        hand.frame(k_dt_s);
    }
    EXPECT_GT(hand.offset.at(k_right).lift_m, 0.0);
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
        hand.frame(k_unbudgeted_s);
        const FingerAngles& angles = hand.pose().target[0];
        EXPECT_GE(angles.opposition_rad, thumb.lower_opposition_rad);
        EXPECT_LE(angles.opposition_rad, thumb.upper_opposition_rad);
        for (std::size_t k = 0; k < thumb.link_count; ++k) {
            EXPECT_GE(angles.curl_rad[k], thumb.lower_rad[k] - 1e-12);
            EXPECT_LE(angles.curl_rad[k], thumb.upper_rad[k] + 1e-12);
        }
        touching += hand.traces[0][0].contact_link >= 0 ? 1 : 0;
    }
    EXPECT_GT(touching, 20);
}

TEST_F(SweepFingers, ThumbOfEmptyHandTakesRestPose) {
    FittedHand hand(beam, {});
    hand.hands.front().body = k_no_entity;
    hand.hands.front().meshes.clear();
    hand.frame(k_unbudgeted_s);
    EXPECT_EQ(hand.pose().shown[0].curl_rad, rig.fingers[0].rest_rad);
    EXPECT_EQ(hand.pose().shown[0].opposition_rad, hand.tuning.thumb.rest_opposition_rad);
}

}  // namespace
}  // namespace handhold::sweep_fingers_test

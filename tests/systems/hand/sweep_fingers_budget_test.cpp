// Which fingers are fitted in which frame.
#include <gtest/gtest.h>

#include "engine/geometry/chain_refit.hpp"
#include "hand_on_beam.hpp"
#include "systems/hand/shared/finger_chain.hpp"

namespace handhold::sweep_fingers_test {
namespace {

TEST_F(SweepFingers, FirstFitsAreSpreadOverFramesAndThumbComesLast) {
    FittedHand hand(beam, on_beam);
    const auto max_refits = static_cast<std::size_t>(hand.tuning.finger.refits_per_frame);
    const auto max_evaluations =
        static_cast<std::uint32_t>(hand.tuning.thumb.evaluations_per_frame);
    std::size_t closed_in_all = 0;
    std::uint32_t thumb_frames = 0;
    for (int frame = 0; frame < 60; ++frame) {
        hand.traces[0] = {};
        hand.frame(k_dt_s);
        std::size_t closed = 0;
        for (std::size_t f = 1; f < rig.fingers.size(); ++f) {
            closed += hand.traces[0][f].discs > 0 ? 1U : 0U;
        }
        EXPECT_LE(closed, max_refits) << frame;
        EXPECT_LE(hand.traces[0][0].discs, max_evaluations * k_disc_planes) << frame;
        if (hand.traces[0][0].discs > 0) {
            EXPECT_GE(closed_in_all + closed, rig.fingers.size() - 1) << frame;
            ++thumb_frames;
        }
        closed_in_all += closed;
    }
    EXPECT_GE(thumb_frames * max_evaluations,
              static_cast<std::uint32_t>(hand.tuning.thumb.opposition_steps));
    EXPECT_LT(deepest_m(hand), 1.5e-3);
    EXPECT_EQ(hand.pose().shown[2].curl_rad, hand.pose().target[2].curl_rad);
}

// A hand that opens at any time during its first fits, and grips again, has its fingers and thumb
// clear like a hand that grips for the first time.
TEST_F(SweepFingers, HandThatOpensDuringItsFitsFitsAgain) {
    for (int open_after = 1; open_after <= 12; ++open_after) {
        FittedHand hand(beam, on_beam);
        for (int frame = 0; frame < open_after; ++frame) {
            hand.frame(k_dt_s);
        }
        const auto meshes = hand.hands.front().meshes;
        hand.hands.front().meshes.clear();
        hand.frame(k_dt_s);
        hand.hands.front().meshes = meshes;
        for (int frame = 0; frame < 60; ++frame) {
            hand.frame(k_dt_s);
        }
        EXPECT_LT(deepest_m(hand), 1.5e-3) << open_after;
    }
}

// Too fast for fits to be carried along: every finger is queued in every frame.
TEST_F(SweepFingers, FastHandRefitsEveryFingerInTurn) {
    FittedHand hand(beam, on_beam);
    constexpr int k_frames = 30;
    std::array<int, k_finger_count> turns = {};
    for (int frame = 0; frame < k_frames; ++frame) {
        hand.traces[0] = {};
        hand.wrist_bs().position.x() = on_beam.position.x() + (frame % 2 == 0 ? 0.01 : -0.01);
        hand.frame(k_dt_s);
        for (std::size_t f = 0; f < rig.fingers.size(); ++f) {
            turns[f] += hand.traces[0][f].discs > 0 ? 1 : 0;
        }
    }
    for (std::size_t f = 0; f < rig.fingers.size(); ++f) {
        EXPECT_GE(turns[f], k_frames / 2 - 3) << f;
    }
}

TEST_F(SweepFingers, KeepsFingersOfStationaryHand) {
    FittedHand hand(beam, on_beam);
    for (int frame = 0; frame < 20; ++frame) {
        hand.frame(k_unbudgeted_s);
    }
    const FingerPose before = hand.pose();
    const std::uint64_t counted = test::count_of_all(hand.stats);
    hand.traces[0] = {};
    hand.wrist_bs().position.x() += 0.5 * hand.tuning.finger.reuse_travel_m;
    hand.frame(k_unbudgeted_s);
    for (std::size_t f = 0; f < rig.fingers.size(); ++f) {
        EXPECT_EQ(hand.pose().target[f].curl_rad, before.target[f].curl_rad);
        EXPECT_EQ(hand.traces[0][f].discs, 0U);  // nothing was searched
    }
    EXPECT_EQ(test::count_of_all(hand.stats), counted);
    hand.wrist_bs().position.x() += 0.01;
    hand.frame(k_unbudgeted_s);
    EXPECT_GT(hand.traces[0][2].discs, 0U);
}

// A finger beside the beam's end touches nothing. Its look-ahead is queried every few millimetres,
// not every frame, and once more when the hand comes to rest.
TEST_F(SweepFingers, FingerTouchingNothingLooksAheadEveryFewMillimetres) {
    Pose at_end = on_beam;
    at_end.position.x() += 0.18;
    FittedHand hand(beam, at_end);
    const auto retry_in_m = [&](std::size_t f) { return hand.pose().lookahead[f].retry_in_m; };
    for (int frame = 0; frame < 30; ++frame) {
        hand.frame(k_dt_s);
    }
    std::size_t open = k_finger_count;
    int queries = 0;
    for (int frame = 0; frame < 40; ++frame) {
        const FingerPose before = hand.pose();
        hand.wrist_bs().position.x() += frame < 15 ? 1e-3 : -2e-4;
        hand.frame(k_dt_s);
        for (std::size_t f = 0; f < rig.fingers.size() && open == k_finger_count; ++f) {
            const bool is_finger = rig.fingers[f].name != FingerName::thumb;
            open = is_finger && retry_in_m(f) > 0.0 && !hand.pose().lookahead[f].has_surface_ahead
                       ? f
                       : open;
        }
        if (open != k_finger_count) {
            queries += retry_in_m(open) > before.lookahead[open].retry_in_m ? 1 : 0;
        }
    }
    ASSERT_NE(open, k_finger_count);
    EXPECT_GE(queries, 5);
    EXPECT_LE(queries, 25);
    for (int frame = 0; frame < 120; ++frame) {
        hand.frame(k_dt_s);
    }
    // At rest, nothing changes any more.
    const FingerPose at_rest = hand.pose();
    for (int frame = 0; frame < 10; ++frame) {
        hand.frame(k_dt_s);
        EXPECT_EQ(hand.pose().target[open].curl_rad, at_rest.target[open].curl_rad) << frame;
    }
}

// Look-ahead is expensive: at most one finger repeats it per frame, and none waits long.
TEST_F(SweepFingers, OneFingerPerFrameLooksAheadAgain) {
    Pose at_end = on_beam;
    at_end.position.x() += 0.3;  // beside the beam's end: no finger touches it
    FittedHand hand(beam, at_end);
    for (int frame = 0; frame < 30; ++frame) {
        hand.frame(k_dt_s);
    }
    ASSERT_NE(hand.surface.at(test::k_right).triangle, GripSurface::k_none);
    int queries = 0;
    double max_interval_m = 0.0;
    constexpr double k_max_interval_m = 0.015;
    constexpr int k_frames = 60;
    constexpr double k_step_m = 1e-3;
    for (int frame = 0; frame < k_frames; ++frame) {
        const FingerPose before = hand.pose();
        hand.wrist_bs().position.x() -= k_step_m;
        hand.frame(k_dt_s);
        int queried = 0;
        for (std::size_t f = 0; f < rig.fingers.size(); ++f) {
            const FingerLookahead& lookahead = hand.pose().lookahead[f];
            const bool is_finger = rig.fingers[f].name != FingerName::thumb;
            queried += is_finger && before.lookahead[f].is_known &&
                       lookahead.travel_since_m == 0.0 &&
                       before.lookahead[f].travel_since_m > 0.0 && lookahead.is_known;
            max_interval_m =
                is_finger ? std::max(max_interval_m, lookahead.travel_since_m) : max_interval_m;
        }
        EXPECT_LE(queried, 1) << frame;
        queries += queried;
    }
    EXPECT_LT(max_interval_m, k_max_interval_m);
    // At least as often as one finger that never touches anything must query.
    EXPECT_GE(queries, k_frames * k_step_m / k_max_interval_m);
}

// A body moves into the thumb of a hand at rest. Oracle: find_penetration.
TEST_F(SweepFingers, ThumbOfStationaryHandYieldsToMovedBody) {
    FittedHand hand(beam, on_beam);
    for (int frame = 0; frame < 20; ++frame) {
        hand.frame(k_unbudgeted_s);
    }
    const auto thumb_capsules = [&] {
        const FingerAngles& angles = hand.pose().target[0];
        return chain_capsules(
            finger_chain(hand.rig.fingers[0], angles.opposition_rad, hand.shown_bs()),
            angles.curl_rad);
    };
    const auto depth_m = [&] {
        double deepest_m = 0.0;
        for (const Capsule& capsule : thumb_capsules()) {
            deepest_m =
                std::max(deepest_m, find_penetration(capsule, hand.hands.front().meshes).depth_m);
        }
        return deepest_m;
    };
    const Capsule tip = thumb_capsules()[hand.rig.fingers[0].link_count - 1];
    const Vec3 along = (tip.ends[1] - tip.ends[0]).normalized();
    // A thin beam whose end penetrates the thumb's tip by 3 mm.
    const Quat turn = rotation_between(Vec3::UnitX(), along);
    const Vec3 end = tip.ends[1] + (tip.radius_m - 0.003) * along;
    const GripMesh stick = build_grip_mesh(make_beam(0.002));
    hand.hands.front().meshes.push_back({&stick, {end + turn * Vec3(0.2, 0.001, 0.0), turn}});
    ASSERT_GT(depth_m(), 2e-3);
    hand.hands.front().signature = 2;
    const Pose before = hand.shown_bs();
    for (int frame = 0; frame < 20; ++frame) {
        hand.frame(k_unbudgeted_s);
    }
    ASSERT_LT((hand.shown_bs().position - before.position).norm(), 1e-6) << "the palm moved";
    EXPECT_LT(depth_m(), 1.5e-3);
}

}  // namespace
}  // namespace handhold::sweep_fingers_test

#include "systems/hand/sweep_fingers.hpp"

#include <gtest/gtest.h>

#include "engine/geometry/chain_refit.hpp"
#include "fitted_hand.hpp"
#include "systems/hand/shared/finger_chain.hpp"

namespace handhold::sweep_fingers_test {
namespace {

using test::FittedHand;
using test::k_right;
using test::k_unbudgeted_s;
using test::Random;
using test::wrist_with_palm_at;

constexpr double k_dt_s = 1.0 / 90.0;

// A beam of 4 cm by 4 cm along x with its top in the plane y = 0; fingers along -Z close around it.
Mesh make_beam(double width_m = 0.04) {
    constexpr std::uint32_t k_pieces = 40;
    const double half_m = 0.5 * width_m;
    const std::array<std::array<double, 2>, 4> ring = {
        {{0.0, half_m}, {0.0, -half_m}, {-width_m, -half_m}, {-width_m, half_m}}};
    Mesh mesh;
    for (std::uint32_t i = 0; i <= k_pieces; ++i) {
        for (const auto& [y, z] : ring) {
            mesh.positions.emplace_back(0.4 * i / k_pieces - 0.2, y, z);
        }
    }
    for (std::uint32_t i = 0; i < k_pieces; ++i) {
        for (std::uint32_t side = 0; side < 4; ++side) {
            const std::uint32_t a = 4 * i + side;
            const std::uint32_t b = 4 * i + (side + 1) % 4;
            mesh.triangles.push_back({a, a + 4, b});
            mesh.triangles.push_back({b, a + 4, b + 4});
        }
    }
    for (const std::uint32_t end : {0U, 4 * k_pieces}) {
        const bool is_first = end == 0;
        mesh.triangles.push_back({end, end + (is_first ? 1U : 2U), end + (is_first ? 2U : 1U)});
        mesh.triangles.push_back({end, end + (is_first ? 2U : 3U), end + (is_first ? 3U : 2U)});
    }
    return mesh;
}

struct SweepFingers : testing::Test {
    GripMesh beam = build_grip_mesh(make_beam());
    const HandRig rig = builtin_hand_rig(HandSide::right);
    // The palm just behind the beam's top, the fingers above it.
    const Pose on_beam = wrist_with_palm_at(rig, {0.003, 0.012, 0.004}, Vec3::UnitY());

    // Largest penetration of the posed digits. Oracle: find_penetration, which has its own tests.
    static double deepest_m(FittedHand& hand) {
        double deepest = 0.0;
        for (std::size_t f = 0; f < hand.rig.fingers.size(); ++f) {
            const FingerAngles& angles = hand.pose().target[f];
            const HingeChain chain =
                finger_chain(hand.rig.fingers[f], angles.opposition_rad, hand.shown_bs());
            const auto capsules = chain_capsules(chain, angles.curl_rad);
            for (std::size_t i = 0; i < chain.link_count; ++i) {
                deepest = std::max(
                    deepest, find_penetration(capsules[i], hand.hands.front().meshes).depth_m);
            }
        }
        return deepest;
    }
};

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

// A hand that opens during its thumb's search starts a new search at the next grip.
TEST_F(SweepFingers, ThumbSearchEndsWithGrip) {
    FittedHand hand(beam, on_beam);
    for (int frame = 0; frame < 8 && hand.pose().thumb_search.evaluated_count == 0; ++frame) {
        hand.frame(k_dt_s);
    }
    ASSERT_TRUE(hand.pose().thumb_search.is_running);
    const auto meshes = hand.hands.front().meshes;
    hand.hands.front().meshes.clear();
    hand.frame(k_dt_s);
    EXPECT_FALSE(hand.pose().thumb_search.is_running);
    EXPECT_EQ(hand.pose().thumb_search.evaluated_count, 0U);
    hand.hands.front().meshes = meshes;
    for (int frame = 0; frame < 60; ++frame) {
        hand.frame(k_dt_s);
    }
    EXPECT_LT(deepest_m(hand), 1.5e-3);
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
    EXPECT_TRUE(hand.pose().converged);
    EXPECT_EQ(hand.pose().lookahead[open].travel_since_m, 0.0);  // queried at the rest position
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

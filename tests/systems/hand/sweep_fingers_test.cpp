#include "systems/hand/sweep_fingers.hpp"

#include <gtest/gtest.h>

#include "engine/geometry/chain_refit.hpp"
#include "fitted_hand.hpp"
#include "systems/hand/shared/finger_chain.hpp"

namespace handhold::sweep_fingers_test {
namespace {

using test::FittedHand;
using test::k_at_once_s;
using test::k_right;
using test::Random;
using test::wrist_with_palm_at;

constexpr double k_dt_s = 1.0 / 90.0;

// A beam of 4 cm by 4 cm along x, its top in the plane y = 0: fingers along -Z close round it.
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
    // The palm just behind the beam's top, the fingers over it.
    const Pose on_beam = wrist_with_palm_at(rig, {0.003, 0.012, 0.004}, Vec3::UnitY());

    // How deep a posed hand's links are, by find_penetration, which has its own tests.
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

TEST_F(SweepFingers, ClosesRoundABeamAndSinksNoFinger) {
    FittedHand hand(beam, on_beam);
    hand.frame(k_at_once_s);
    EXPECT_LT(deepest_m(hand), 1.5e-3);
    int touching = 0;
    for (std::size_t f = 0; f < rig.fingers.size(); ++f) {
        touching += hand.traces[0][f].contact_link >= 0 ? 1 : 0;
    }
    EXPECT_GE(touching, 4);
}

TEST_F(SweepFingers, OpensAtOnceAndClosesAtItsRate) {
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
    // Arrived; then the hand lets go and its fingers are at ease within one frame where that opens.
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

// A hand that slides back and forth over a beam, now beyond its edge, turning: fingers that are
// sunk change from under the beam to over it and back. What opens a finger by following its surface
// opens a hinge by a share of its range in a frame; a change adds what its rate allows.
TEST_F(SweepFingers, ChangesFromFitToFitAreNotShownInOneFrame) {
    const ChainRefitSettings refit;
    double range_rad = 0.0;
    for (const FingerRig& finger : rig.fingers) {
        for (std::size_t i = 0; i < finger.link_count; ++i) {
            range_rad = std::max(range_rad, finger.upper_rad[i] - finger.lower_rad[i]);
        }
    }
    const double followed_rad = refit.open_share * refit.open_steps * range_rad;
    const auto most_opened_rad = [&](double transition_radps) {
        FittedHand hand(beam, on_beam);
        hand.tuning.finger.transition_radps = transition_radps;
        hand.frame(k_at_once_s);
        double most_rad = 0.0;
        for (int frame = 0; frame < 540; ++frame) {
            const FingerPose before = hand.pose();
            const double turn = 2.0 * M_PI * frame / 180.0;
            const Quat yaw = rotation_about(Vec3::UnitY(), 0.6 * std::sin(0.7 * turn));
            hand.wrist_bs() =
                on_beam * Pose{Vec3(0.01 * std::sin(0.3 * turn), 0.0, 0.06 * std::sin(turn)), yaw};
            hand.frame(k_dt_s);
            for (std::size_t f = 0; f < rig.fingers.size(); ++f) {
                for (std::size_t i = 0; i < rig.fingers[f].link_count; ++i) {
                    most_rad = std::max(
                        most_rad, before.shown[f].curl_rad[i] - hand.pose().shown[f].curl_rad[i]);
                }
            }
        }
        return most_rad;
    };
    const double transition_radps = FingerTuning{}.transition_radps;
    EXPECT_LE(most_opened_rad(transition_radps), transition_radps * k_dt_s + followed_rad);
    EXPECT_GT(most_opened_rad(1e6), 2.0 * (transition_radps * k_dt_s + followed_rad));
}

// A hand that grips pays for a few fingers in each frame; the thumb comes when they are closed.
TEST_F(SweepFingers, ClosesAFewFingersInAFrameAndThenTheThumb) {
    FittedHand hand(beam, on_beam);
    const auto most = static_cast<std::size_t>(hand.tuning.finger.refits_per_frame);
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
        EXPECT_LE(closed, most) << frame;
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

// A hand that opens while its thumb is on its way through its oppositions begins anew where it
// grips next.
TEST_F(SweepFingers, ThumbsSearchEndsWithTheGrip) {
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

// Faster than fits can be kept: all are to be closed anew in every frame.
TEST_F(SweepFingers, EveryFingerOfAFastHandHasItsTurn) {
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

TEST_F(SweepFingers, KeepsTheFingersOfAHandThatStands) {
    FittedHand hand(beam, on_beam);
    for (int frame = 0; frame < 20; ++frame) {
        hand.frame(k_at_once_s);
    }
    const FingerPose before = hand.pose();
    const std::uint64_t counted = test::count_of_all(hand.stats);
    hand.traces[0] = {};
    hand.wrist_bs().position.x() += 0.5 * hand.tuning.finger.reuse_travel_m;
    hand.frame(k_at_once_s);
    for (std::size_t f = 0; f < rig.fingers.size(); ++f) {
        EXPECT_EQ(hand.pose().target[f].curl_rad, before.target[f].curl_rad);
        EXPECT_EQ(hand.traces[0][f].discs, 0U);  // nothing was searched
    }
    EXPECT_EQ(test::count_of_all(hand.stats), counted);
    hand.wrist_bs().position.x() += 0.01;
    hand.frame(k_at_once_s);
    EXPECT_GT(hand.traces[0][2].discs, 0U);
}

// A finger stands out beside the beam's end. That there is nothing to touch is looked for when
// they have gone a few millimetres, not in every frame; and a hand that comes to rest is done.
TEST_F(SweepFingers, FingersWithNothingToTouchLookAheadNowAndThen) {
    Pose at_end = on_beam;
    at_end.position.x() += 0.18;
    FittedHand hand(beam, at_end);
    const auto waits_m = [&](std::size_t f) { return hand.pose().lookahead[f].retry_in_m; };
    for (int frame = 0; frame < 30; ++frame) {
        hand.frame(k_dt_s);
    }
    std::size_t open = k_finger_count;
    int looks = 0;
    for (int frame = 0; frame < 40; ++frame) {
        const FingerPose before = hand.pose();
        hand.wrist_bs().position.x() += frame < 15 ? 1e-3 : -2e-4;
        hand.frame(k_dt_s);
        for (std::size_t f = 0; f < rig.fingers.size() && open == k_finger_count; ++f) {
            const bool is_finger = rig.fingers[f].name != FingerName::thumb;
            open = is_finger && waits_m(f) > 0.0 && !hand.pose().lookahead[f].has_surface_ahead
                       ? f
                       : open;
        }
        if (open != k_finger_count) {
            looks += waits_m(open) > before.lookahead[open].retry_in_m ? 1 : 0;
        }
    }
    ASSERT_NE(open, k_finger_count);
    EXPECT_GE(looks, 5);
    EXPECT_LE(looks, 25);
    for (int frame = 0; frame < 120; ++frame) {
        hand.frame(k_dt_s);
    }
    EXPECT_TRUE(hand.pose().converged);
    EXPECT_EQ(hand.pose().lookahead[open].travel_since_m, 0.0);  // it looked where it stands
}

// Looking ahead is dear: of the fingers that have looked before, one looks again in a frame, and
// none waits long for its turn.
TEST_F(SweepFingers, OneFingerInAFrameLooksAheadAgain) {
    Pose at_end = on_beam;
    at_end.position.x() += 0.3;  // beside the beam's end: all fingers are in the air
    FittedHand hand(beam, at_end);
    for (int frame = 0; frame < 30; ++frame) {
        hand.frame(k_dt_s);
    }
    ASSERT_NE(hand.surface.at(test::k_right).triangle, GripSurface::k_none);
    int looks = 0;
    double longest_m = 0.0;
    constexpr double k_longest_m = 0.015;
    constexpr int k_frames = 60;
    constexpr double k_step_m = 1e-3;
    for (int frame = 0; frame < k_frames; ++frame) {
        const FingerPose before = hand.pose();
        hand.wrist_bs().position.x() -= k_step_m;
        hand.frame(k_dt_s);
        int looked = 0;
        for (std::size_t f = 0; f < rig.fingers.size(); ++f) {
            const FingerLookahead& lookahead = hand.pose().lookahead[f];
            const bool is_finger = rig.fingers[f].name != FingerName::thumb;
            looked += is_finger && before.lookahead[f].is_known &&
                      lookahead.travel_since_m == 0.0 && before.lookahead[f].travel_since_m > 0.0 &&
                      lookahead.is_known;
            longest_m = is_finger ? std::max(longest_m, lookahead.travel_since_m) : longest_m;
        }
        EXPECT_LE(looked, 1) << frame;
        looks += looked;
    }
    EXPECT_LT(longest_m, k_longest_m);
    // As often as that makes of one finger alone that stays in the air.
    EXPECT_GE(looks, k_frames * k_step_m / k_longest_m);
}

// What comes near does so without the hand. Expected: by find_penetration.
TEST_F(SweepFingers, ThumbOfAHandThatStandsGivesWayToWhatComesNear) {
    FittedHand hand(beam, on_beam);
    for (int frame = 0; frame < 20; ++frame) {
        hand.frame(k_at_once_s);
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
    // Another beam's end, 3 mm into the thumb's.
    const Quat turn = rotation_between(Vec3::UnitX(), along);
    const Vec3 end = tip.ends[1] + (tip.radius_m - 0.003) * along;
    const GripMesh stick = build_grip_mesh(make_beam(0.002));
    hand.hands.front().meshes.push_back({&stick, {end + turn * Vec3(0.2, 0.001, 0.0), turn}});
    ASSERT_GT(depth_m(), 2e-3);
    hand.hands.front().signature = 2;
    const Pose before = hand.shown_bs();
    for (int frame = 0; frame < 20; ++frame) {
        hand.frame(k_at_once_s);
    }
    ASSERT_LT((hand.shown_bs().position - before.position).norm(), 1e-6) << "the palm gave way";
    EXPECT_LT(depth_m(), 1.5e-3);
}

TEST_F(SweepFingers, EmptyHandsAreAtEaseOrAFist) {
    FittedHand hand(beam, {});
    hand.hands.front().body = k_no_entity;
    hand.hands.front().is_gripping = false;
    hand.hands.front().meshes.clear();
    hand.tracking.at(k_right).pressed = false;
    hand.frame(k_at_once_s);
    const FingerPose at_ease = hand.pose();
    hand.tracking.at(k_right).pressed = true;
    hand.frame(k_at_once_s);
    for (std::size_t f = 1; f < rig.fingers.size(); ++f) {
        EXPECT_EQ(at_ease.shown[f].curl_rad, rig.fingers[f].rest_rad);
        for (std::size_t i = 0; i < rig.fingers[f].link_count; ++i) {
            EXPECT_GT(hand.pose().shown[f].curl_rad[i], at_ease.shown[f].curl_rad[i]);
            EXPECT_LE(hand.pose().shown[f].curl_rad[i], rig.fingers[f].upper_rad[i]);
        }
    }
}

TEST_F(SweepFingers, HandOnAMovingBodyIsPosedAsOnAStandingOne) {
    Random random(2301);
    FittedHand standing(beam, on_beam);
    standing.frame(k_at_once_s);
    for (int i = 0; i < 10; ++i) {
        FittedHand moving(beam, on_beam);
        moving.hands.front().body_ws = random.pose(20.0);
        moving.frame(k_at_once_s);
        EXPECT_LT((moving.shown_bs().position - standing.shown_bs().position).norm(), 1e-9);
        for (std::size_t f = 0; f < rig.fingers.size(); ++f) {
            // 0.25 mm of a finger's end: which corners a walk leaves out, a rounding error decides.
            for (std::size_t k = 0; k < k_max_links; ++k) {
                EXPECT_NEAR(moving.pose().target[f].curl_rad[k],
                            standing.pose().target[f].curl_rad[k], 0.01)
                    << "finger " << f;
            }
        }
    }
}

TEST_F(SweepFingers, LeftHandIsTheMirrorOfTheRightOne) {
    // The beam is its own mirror image in the plane x = 0, but for its diagonals.
    const Pose wrist = on_beam;
    FittedHand right(beam, wrist);
    FittedHand left(beam, test::mirrored(wrist), HandSide::left);
    right.frame(k_at_once_s);
    left.frame(k_at_once_s);
    EXPECT_LT((test::mirrored(left.shown_bs()).position - right.shown_bs().position).norm(), 1e-6);
    for (std::size_t f = 0; f < rig.fingers.size(); ++f) {
        for (std::size_t k = 0; k < k_max_links; ++k) {
            EXPECT_NEAR(left.pose().target[f].curl_rad[k], right.pose().target[f].curl_rad[k], 0.01)
                << "finger " << f;
        }
    }
}

TEST_F(SweepFingers, FingersThatStaySunkLiftThePalmByTheNextFrame) {
    FittedHand hand(beam, on_beam);
    hand.tuning.palm.lift_from_depth_m = -1.0;  // every hand counts as sunk
    double before_m = 0.0;
    for (int frame = 0; frame < 6; ++frame) {
        hand.frame(k_at_once_s);
        const double lift_m = hand.offset.at(k_right).lift_m;
        EXPECT_GE(lift_m, before_m);
        EXPECT_LE(lift_m, 3.0 * hand.tuning.palm.lift_m + 1e-12);
        before_m = lift_m;
    }
    EXPECT_NEAR(before_m, 3.0 * hand.tuning.palm.lift_m, 1e-12);
    EXPECT_EQ(test::count_of(hand.stats, Fallback::palm_lifted), 3U);
}

// Fingers that are not sunk so deep as to be tried anew have no turn to wait for.
TEST_F(SweepFingers, FingersHardlySunkLiftThePalmWhereADesignerWantsIt) {
    FittedHand hand(beam, on_beam);
    hand.tuning.finger.search_depth_m = 0.1;
    hand.frame(k_at_once_s);
    for (int frame = 0; frame < 180; ++frame) {
        if (frame == 60) {  // long after they were closed
            ASSERT_EQ(hand.offset.at(k_right).lift_m, 0.0);
            hand.tuning.palm.lift_from_depth_m = 1e-6;
        }
        hand.wrist_bs() =
            on_beam * Pose{Vec3(0.0, 0.0, 0.01 * std::sin(0.05 * frame)), Quat::Identity()};
        hand.frame(k_dt_s);
    }
    EXPECT_GT(hand.offset.at(k_right).lift_m, 0.0);
}

TEST_F(SweepFingers, ThumbsOppositionStaysWithinItsRange) {
    Random random(2302);
    const FingerRig& thumb = rig.fingers[0];
    ASSERT_EQ(thumb.name, FingerName::thumb);
    int touching = 0;
    for (int i = 0; i < 40; ++i) {
        const Vec3 up = (Vec3::UnitY() + random.vector(0.4)).normalized();
        FittedHand hand(beam,
                        wrist_with_palm_at(rig, Vec3(0.0, 0.01, 0.0) + random.vector(0.015), up));
        hand.frame(k_at_once_s);
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

TEST_F(SweepFingers, ThumbOfAnEmptyHandRests) {
    FittedHand hand(beam, {});
    hand.hands.front().body = k_no_entity;
    hand.hands.front().meshes.clear();
    hand.frame(k_at_once_s);
    EXPECT_EQ(hand.pose().shown[0].curl_rad, rig.fingers[0].rest_rad);
    EXPECT_EQ(hand.pose().shown[0].opposition_rad, hand.tuning.thumb.rest_opposition_rad);
}

}  // namespace
}  // namespace handhold::sweep_fingers_test

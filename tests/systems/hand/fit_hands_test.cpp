#include "systems/hand/fit_hands.hpp"

#include <gtest/gtest.h>

#include "beam.hpp"
#include "systems/hand/shared/hand_fit.hpp"
#include "systems/rigs/hand_kinematics.hpp"

namespace handhold::fit_hands_test {
namespace {

using test::FittedHand;
using test::k_right;
using test::k_unlimited_s;
using test::Random;
using test::wrist_with_palm_at;

constexpr double k_dt_s = 1.0 / 90.0;

Vec3 knuckle_to_tip(const FingerRig& finger, const FingerAngles& angles) {
    const auto points = finger_points(finger, angles);
    return points[finger.link_count] - points[0];
}

// Least gap between a thumb's and a finger's link, sampled every 2 % of their lengths.
double least_thumb_gap_m(const HandRig& rig, const FingerPose& pose) {
    constexpr int k_samples = 50;
    double least_m = 1.0;
    const auto thumb = finger_points(rig.fingers[0], pose.target[0]);
    for (std::size_t f = 1; f < rig.fingers.size(); ++f) {
        const auto finger = finger_points(rig.fingers[f], pose.target[f]);
        for (std::size_t a = 0; a < rig.fingers[0].link_count; ++a) {
            for (std::size_t b = 0; b < rig.fingers[f].link_count; ++b) {
                for (int i = 0; i <= k_samples * k_samples; ++i) {
                    const double s = static_cast<double>(i % k_samples) / k_samples;
                    const double t = static_cast<double>(i / k_samples) / k_samples;
                    const Vec3 on_thumb = thumb[a] + s * (thumb[a + 1] - thumb[a]);
                    const Vec3 on_finger = finger[b] + t * (finger[b + 1] - finger[b]);
                    least_m = std::min(least_m, (on_thumb - on_finger).norm() -
                                                    rig.fingers[0].radius_m[a] -
                                                    rig.fingers[f].radius_m[b]);
                }
            }
        }
    }
    return least_m;
}

struct FitHands : testing::Test {
    GripMesh beam = build_grip_mesh(test::make_beam());
    GripMesh floor = build_grip_mesh(test::make_floor_mesh());
    const HandRig rig = builtin_hand_rig(HandSide::right);
    const Pose on_beam = wrist_with_palm_at(rig, {0.003, 0.012, 0.004}, Vec3::UnitY());

    static double bend_rad(const HandRig& rig, const FingerPose& pose, std::size_t f) {
        double sum_rad = 0.0;
        for (std::size_t i = 0; i < rig.fingers[f].link_count; ++i) {
            sum_rad += pose.target[f].curl_rad[i];
        }
        return sum_rad;
    }
};

// Oracle: find_penetration, which has its own tests.
TEST_F(FitHands, FittedHandDoesNotPenetrateAndStaysWithinLimits) {
    Random random(2501);
    int deep = 0;
    for (int i = 0; i < 60; ++i) {
        const Vec3 up = (Vec3::UnitY() + random.vector(0.4)).normalized();
        const Vec3 center = Vec3(0.0, 0.01, 0.0) + random.vector(0.02);
        FittedHand hand(beam, wrist_with_palm_at(rig, center, up));
        hand.frame(k_unlimited_s);
        const FingerPose& pose = hand.pose();
        deep += test::deepest_digit_m(hand, pose.target, hand.shown_bs()) > 1.5e-3 ? 1 : 0;
        for (const PalmCapsule& capsule : rig.palm) {
            const Capsule shown = {{transform_point(hand.shown_bs(), capsule.a_hs),
                                    transform_point(hand.shown_bs(), capsule.b_hs)},
                                   capsule.radius_m};
            EXPECT_LT(find_penetration(shown, hand.hands.front().meshes).depth_m, 3e-3) << i;
        }
        for (std::size_t f = 0; f < rig.fingers.size(); ++f) {
            for (std::size_t k = 0; k < rig.fingers[f].link_count; ++k) {
                EXPECT_GE(pose.target[f].curl_rad[k], rig.fingers[f].lower_rad[k]);
                EXPECT_LE(pose.target[f].curl_rad[k], rig.fingers[f].upper_rad[k]);
            }
        }
    }
    EXPECT_LE(deep, 2);
}

// A palm held so low that its digits press into the beam, whose windings are random. Closed digits
// that no surface goes through stay on their side, whatever the winding under the palm.
TEST_F(FitHands, DigitsStayOnTheSideWhereTheyClosed) {
    Random random(2503);
    int pressed = 0;
    for (int i = 0; i < 40; ++i) {
        Mesh mesh = test::make_beam();
        for (auto& [a, b, c] : mesh.triangles) {
            if (random.between(0.0, 1.0) < 0.5) {
                std::swap(b, c);
            }
        }
        const GripMesh grip_mesh = build_grip_mesh(mesh);
        const Vec3 center{random.between(-0.05, 0.05), random.between(-0.008, 0.002), 0.0};
        const Vec3 up = (Vec3::UnitY() + random.vector(0.3)).normalized();
        AuthoredHand held;
        held.is_there = true;
        held.wrist_bs = wrist_with_palm_at(rig, center, up);
        FittedHand hand(grip_mesh, held.wrist_bs);
        hand.hands.front().authored = &held;
        hand.frame(k_unlimited_s);
        const FingerPose closing = hand.pose();
        const Pose wrist_bs = hand.shown_bs();
        for (int frame = 0; frame < 5; ++frame) {
            hand.frame(k_unlimited_s);
        }
        for (std::size_t f = 0; f < rig.fingers.size(); ++f) {
            const double closed_m = test::digit_depth_m(hand, f, closing.closed[f], wrist_bs);
            if (closed_m < clear_depth_m(rig.fingers[f]) - 1e-4) {
                pressed += closed_m > 3e-3 ? 1 : 0;
                EXPECT_LT(test::digit_depth_m(hand, f, hand.pose().target[f], hand.shown_bs()),
                          clear_depth_m(rig.fingers[f]) - 1e-6)
                    << i << ", finger " << f << ", closed " << closed_m;
            }
        }
    }
    EXPECT_GT(pressed, 5);
}

// Palms at random places on a thin rod, around which fingers and thumb meet. Oracle: sampled
// distances between the links' axes.
TEST_F(FitHands, ThumbStaysOutOfTheFingers) {
    Random random(2506);
    const GripMesh rod = build_grip_mesh(test::make_beam(0.012));
    int near = 0;
    for (int i = 0; i < 30; ++i) {
        const Vec3 up = (Vec3::UnitY() + random.vector(0.5)).normalized();
        const Vec3 center{random.between(-0.1, 0.1), 0.012, random.between(-0.02, 0.02)};
        FittedHand hand(rod, wrist_with_palm_at(rig, center, up));
        for (int frame = 0; frame < 5; ++frame) {
            hand.frame(k_unlimited_s);
        }
        const double gap_m = least_thumb_gap_m(rig, hand.pose());
        EXPECT_GT(gap_m, -2e-3) << i;
        near += gap_m < 2e-3 ? 1 : 0;
    }
    EXPECT_GT(near, 0);
}

// Beside the beam's end, some fingers close around it and others reach nothing.
TEST_F(FitHands, FingersDoNotFanOut) {
    Random random(2507);
    for (int i = 0; i < 20; ++i) {
        Pose at_end = on_beam;
        at_end.position.x() += random.between(0.15, 0.22);
        FittedHand hand(beam, at_end);
        for (int frame = 0; frame < 5; ++frame) {
            hand.frame(k_unlimited_s);
        }
        for (std::size_t f = 2; f < rig.fingers.size(); ++f) {
            const Vec3 one = knuckle_to_tip(rig.fingers[f - 1], hand.pose().target[f - 1]);
            const Vec3 other = knuckle_to_tip(rig.fingers[f], hand.pose().target[f]);
            EXPECT_LT(arc_tangent2(one.cross(other).norm(), one.dot(other)), 40.0 * k_degree)
                << i << ", finger " << f;
        }
    }
}

// Beyond the beam's end a finger reaches nothing.
TEST_F(FitHands, FingerThatReachesNothingGoesWithItsNeighbour) {
    Pose at_end = on_beam;
    at_end.position.x() += 0.19;
    FittedHand hand(beam, at_end);
    hand.frame(k_unlimited_s);
    int free = 0;
    int touching = 0;
    for (std::size_t f = 1; f < rig.fingers.size(); ++f) {
        free += hand.pose().touches[f] ? 0 : 1;
        touching += hand.pose().touches[f] ? 1 : 0;
    }
    ASSERT_GT(free, 0);
    ASSERT_GT(touching, 0);
    for (std::size_t f = 2; f < rig.fingers.size(); ++f) {
        EXPECT_NEAR(bend_rad(rig, hand.pose(), f), bend_rad(rig, hand.pose(), f - 1),
                    60.0 * k_degree)
            << f;
    }
}

// The wrist turns about its anchor as it does in play: 0.4 degrees in a frame.
TEST_F(FitHands, TurningHandMovesContinuously) {
    FittedHand hand(beam, on_beam);
    for (int frame = 0; frame < 30; ++frame) {
        hand.frame(k_dt_s);
    }
    constexpr double k_max_rad = 10.0 * k_degree;
    for (int frame = 0; frame < 180; ++frame) {
        const FingerPose before = hand.pose();
        const Pose shown = hand.shown_bs();
        const double turn_rad = 0.15 * sine(0.045 * frame);
        hand.wrist_bs().rotation =
            (on_beam.rotation * rotation_about(Vec3(0.6, 0.0, 0.8), turn_rad)).normalized();
        hand.frame(k_dt_s);
        EXPECT_LT((hand.shown_bs().position - shown.position).norm(), 5e-3) << frame;
        for (std::size_t f = 0; f < rig.fingers.size(); ++f) {
            for (std::size_t k = 0; k < rig.fingers[f].link_count; ++k) {
                EXPECT_NEAR(hand.pose().target[f].curl_rad[k], before.target[f].curl_rad[k],
                            k_max_rad)
                    << frame << ", finger " << f;
            }
        }
    }
    EXPECT_LT(test::deepest_digit_m(hand, hand.pose().target, hand.shown_bs()), 1.5e-3);
}

// A hand on the floor, 6 cm before a wall, turns far about any axis. Fits from the last one lead
// into floor and wall (28 % of the frames, up to 143 in a row), but the hand then closes again.
// When it rests, it no longer closes.
TEST_F(FitHands, HandsThatTurnFarDoNotStayInSolids) {
    constexpr int k_hands = 30;
    constexpr int k_frames = 160;
    constexpr int k_turning_frames = 80;
    constexpr int k_resting_frames = 20;
    const GripMesh corner = build_grip_mesh(test::make_corner_mesh(0.06));
    int deep = 0;
    int longest = 0;
    for (unsigned seed = 1; seed <= k_hands; ++seed) {
        Random random(seed);
        FittedHand hand(corner, on_beam);
        const Vec3 axis = random.direction();
        const double far_rad = random.between(40.0, 90.0) * k_degree;
        int in_solid = 0;
        for (int frame = 0; frame < k_frames; ++frame) {
            const double share = std::min(1.0, static_cast<double>(frame) / k_turning_frames);
            hand.wrist_bs().rotation =
                (on_beam.rotation * rotation_about(axis, share * far_rad)).normalized();
            hand.search();
            hand.constrain();
            hand.sweep();
            if (frame >= k_frames - k_resting_frames) {
                EXPECT_FALSE(hand.pose().is_newly_closed) << seed;
            }
            hand.fit(k_unlimited_s);
            const bool is_deep =
                test::deepest_digit_m(hand, hand.pose().target, hand.shown_bs()) > 3e-3;
            in_solid = is_deep ? in_solid + 1 : 0;
            deep += is_deep ? 1 : 0;
            longest = std::max(longest, in_solid);
        }
    }
    EXPECT_LT(deep, 8 * k_hands * k_frames / 100);
    EXPECT_LT(longest, 12);
}

TEST_F(FitHands, StationaryHandConvergesAndKeepsItsFit) {
    FittedHand hand(beam, on_beam);
    int frames = 0;
    while (!hand.pose().is_converged && frames < 200) {
        hand.frame(k_dt_s);
        ++frames;
    }
    ASSERT_LT(frames, 200);
    const FingerPose before = hand.pose();
    const Vec3 target_m = hand.offset.at(k_right).target_m;
    hand.frame(k_dt_s);
    EXPECT_EQ(hand.offset.at(k_right).target_m, target_m);
    for (std::size_t f = 0; f < rig.fingers.size(); ++f) {
        EXPECT_EQ(hand.pose().target[f].curl_rad, before.target[f].curl_rad);
    }
}

// Each fit after the closing also starts from another thumb. It costs at most a tenth more than the
// one before: a fit corrects some gaps by travel alone. After the last one the hand rests.
TEST_F(FitHands, OtherThumbsCostNoMoreAndTheHandRestsAfterThem) {
    Random random(2511);
    int changed = 0;
    int rest = 0;
    for (int i = 0; i < 40; ++i) {
        const Pose wrist_bs{
            on_beam.position + random.vector(0.02),
            (on_beam.rotation * rotation_about(random.direction(), 0.5)).normalized()};
        FittedHand hand(beam, wrist_bs);
        const auto cost_m2 = [&] {
            const auto terms = shown_fit_terms(hand.hands.front(), hand.surface.at(k_right),
                                               hand.palm.at(k_right), hand.pose(), hand.tuning);
            return terms ? sum_of(*terms) : 0.0;
        };
        hand.frame(k_unlimited_s);
        EXPECT_EQ(hand.pose().thumbs_tried, 0U);
        const FingerAngles closed = hand.pose().target[0];
        for (std::uint32_t frame = 1; frame <= k_thumb_tries; ++frame) {
            const double before_m2 = cost_m2();
            hand.frame(k_unlimited_s);
            EXPECT_LE(cost_m2(), 1.1 * before_m2 + 1e-9) << i << ", frame " << frame;
        }
        const FingerAngles& thumb = hand.pose().target[0];
        changed += std::abs(thumb.opposition_rad - closed.opposition_rad) > 0.3 ? 1 : 0;
        for (int frame = 0; frame < 60 && !hand.pose().is_converged; ++frame) {
            hand.frame(k_unlimited_s);
        }
        EXPECT_LT(test::deepest_digit_m(hand, hand.pose().target, hand.shown_bs()), 3e-3) << i;
        const FingerPose before = hand.pose();
        const Vec3 target_m = hand.offset.at(k_right).target_m;
        rest += before.is_converged ? 1 : 0;
        for (int frame = 0; frame < 10 && before.is_converged; ++frame) {
            hand.frame(k_unlimited_s);
            ASSERT_EQ(hand.offset.at(k_right).target_m, target_m) << i;
            for (std::size_t f = 0; f < rig.fingers.size(); ++f) {
                ASSERT_EQ(hand.pose().target[f].curl_rad, before.target[f].curl_rad) << i;
                ASSERT_EQ(hand.pose().target[f].opposition_rad, before.target[f].opposition_rad);
            }
        }
        hand.hands.front().is_gripping = false;
        hand.surface.at(k_right) = {};
        hand.sweep();
        hand.fit(k_unlimited_s);
        hand.hands.front().is_gripping = true;
        hand.frame(k_unlimited_s);
        EXPECT_EQ(hand.pose().thumbs_tried, 0U) << "a new grip";
    }
    EXPECT_GT(changed, 1);
    EXPECT_GE(rest, 38);  // the others tremble by micrometres
}

TEST_F(FitHands, FitDoesNotDependOnBodyPose) {
    Random random(2502);
    FittedHand at_origin(beam, on_beam);
    at_origin.frame(k_unlimited_s);
    for (int i = 0; i < 10; ++i) {
        FittedHand elsewhere(beam, on_beam);
        elsewhere.hands.front().body_ws = random.pose(20.0);
        elsewhere.frame(k_unlimited_s);
        EXPECT_LT((elsewhere.shown_bs().position - at_origin.shown_bs().position).norm(), 1e-9);
        for (std::size_t f = 0; f < rig.fingers.size(); ++f) {
            EXPECT_EQ(elsewhere.pose().target[f].curl_rad, at_origin.pose().target[f].curl_rad);
        }
    }
}

TEST_F(FitHands, LeftHandMirrorsRightHand) {
    FittedHand right(beam, on_beam);
    FittedHand left(beam, test::mirrored(on_beam), HandSide::left);
    right.frame(k_unlimited_s);
    left.frame(k_unlimited_s);
    EXPECT_LT((test::mirrored(left.shown_bs()).position - right.shown_bs().position).norm(), 1e-3);
    for (std::size_t f = 0; f < rig.fingers.size(); ++f) {
        for (std::size_t k = 0; k < k_max_links; ++k) {
            EXPECT_NEAR(left.pose().target[f].curl_rad[k], right.pose().target[f].curl_rad[k], 0.03)
                << "finger " << f;
        }
    }
}

// A body moves into the thumb of a hand at rest.
TEST_F(FitHands, ThumbOfStationaryHandYieldsToMovedBody) {
    FittedHand hand(beam, on_beam);
    for (int frame = 0; frame < 20; ++frame) {
        hand.frame(k_unlimited_s);
    }
    const auto depth_m = [&] {
        return test::deepest_digit_m(hand, hand.pose().target, hand.shown_bs());
    };
    const FingerAngles& angles = hand.pose().target[0];
    const auto capsules = chain_capsules(
        finger_chain(rig.fingers[0], angles.opposition_rad, hand.shown_bs()), angles.curl_rad);
    const Capsule tip = capsules[rig.fingers[0].link_count - 1];
    const Vec3 along = (tip.ends[1] - tip.ends[0]).normalized();
    // A thin beam whose end penetrates the thumb's tip by 3 mm.
    const Quat turn = rotation_between(Vec3::UnitX(), along);
    const Vec3 end = tip.ends[1] + (tip.radius_m - 0.003) * along;
    const GripMesh stick = build_grip_mesh(test::make_beam(0.002));
    hand.hands.front().meshes.push_back({&stick, {end + turn * Vec3(0.2, 0.001, 0.0), turn}});
    ASSERT_GT(depth_m(), 2e-3);
    hand.hands.front().signature = 2;
    for (int frame = 0; frame < 20; ++frame) {
        hand.frame(k_unlimited_s);
    }
    EXPECT_LT(depth_m(), 1.5e-3);
}

}  // namespace
}  // namespace handhold::fit_hands_test

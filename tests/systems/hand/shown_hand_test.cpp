// The hand that is drawn: its rates, and a hand that holds nothing.
#include <gtest/gtest.h>

#include "beam.hpp"
#include "systems/hand/fit_hands.hpp"
#include "systems/rigs/hand_kinematics.hpp"

namespace handhold::shown_hand_test {
namespace {

using test::FittedHand;
using test::k_right;
using test::k_unlimited_s;
using test::Random;
using test::wrist_with_palm_at;

constexpr double k_dt_s = 1.0 / 90.0;

void let_go(FittedHand& hand) {
    hand.hands.front().body = k_no_entity;
    hand.hands.front().is_gripping = false;
    hand.hands.front().meshes.clear();
    hand.tracking.at(k_right).pressed = false;
}

// Height of the lowest point of the skin of a shown hand, if its wrist were at `wrist`.
double lowest_skin_m(const FittedHand& hand, const Pose& wrist) {
    double lowest_m = 1.0;
    test::visit_axis_ends(hand, wrist, [&](const Vec3& end, double radius_m) {
        lowest_m = std::min(lowest_m, end.y() - radius_m);
    });
    return lowest_m;
}

struct ShownHand : testing::Test {
    GripMesh beam = build_grip_mesh(test::make_beam());
    GripMesh floor = build_grip_mesh(test::make_floor_mesh());
    const HandRig rig = builtin_hand_rig(HandSide::right);
    const Pose on_beam = wrist_with_palm_at(rig, {0.003, 0.012, 0.004}, Vec3::UnitY());
};

TEST_F(ShownHand, ShownFingersKeepTheirRates) {
    FittedHand hand(beam, on_beam);
    hand.tuning.finger.close_radps = 2.0;
    hand.tuning.finger.open_radps = 3.0;
    FingerPose before = hand.pose();
    for (int frame = 0; frame < 240; ++frame) {
        if (frame == 120) {
            let_go(hand);
        }
        hand.frame(k_dt_s);
        const FingerPose& now = hand.pose();
        for (std::size_t f = 0; f < rig.fingers.size(); ++f) {
            for (std::size_t i = 0; i < rig.fingers[f].link_count; ++i) {
                const double step_rad = now.shown[f].curl_rad[i] - before.shown[f].curl_rad[i];
                EXPECT_LE(step_rad, 2.0 * k_dt_s + 1e-12);
                EXPECT_GE(step_rad, -3.0 * k_dt_s - 1e-12);
            }
        }
        before = now;
    }
    EXPECT_EQ(before.shown[2].curl_rad, rig.fingers[2].rest_rad);
}

// Angles that arrived one after the other would swing a digit through what it is to touch.
TEST_F(ShownHand, AnglesOfADigitAdvanceByOneShare) {
    FittedHand hand(beam, on_beam);
    hand.tuning.finger.close_radps = 2.0;
    hand.tuning.finger.open_radps = 3.0;
    int moved = 0;
    for (int frame = 0; frame < 240; ++frame) {
        if (frame == 120) {
            let_go(hand);
        }
        const FingerPose before = hand.pose();
        hand.frame(k_dt_s);
        const FingerPose& now = hand.pose();
        for (std::size_t f = 0; f < rig.fingers.size(); ++f) {
            const auto angles = [](const FingerAngles& of) {
                return Eigen::Vector4d(of.curl_rad[0], of.curl_rad[1], of.curl_rad[2],
                                       of.opposition_rad);
            };
            const Eigen::Vector4d step = angles(now.shown[f]) - angles(before.shown[f]);
            const Eigen::Vector4d wanted = angles(now.target[f]) - angles(before.shown[f]);
            if (wanted.norm() > 1e-6) {
                EXPECT_NEAR(step.dot(wanted), step.norm() * wanted.norm(), 1e-9);
                ++moved;
            }
        }
    }
    EXPECT_GT(moved, 100);
}

// Small offsets at the tuning's rate; of large ones a share in each frame.
TEST_F(ShownHand, ShownOffsetIsNeverFasterThanItsRateOrShare) {
    FittedHand hand(floor, wrist_with_palm_at(rig, {0.0, -0.02, 0.0}, Vec3::UnitY()));
    Random random(2102);
    const PalmTuning& tuning = hand.tuning.palm;
    const auto way_m = [&](const Vec3& moved_m, const Vec3& turn_rad) {
        return moved_m.norm() + tuning.tilt_cost_m_per_rad * turn_rad.norm();
    };
    PalmOffset before;
    for (int frame = 0; frame < 200; ++frame) {
        if (frame % 20 == 0) {
            const double y = random.between(-0.03, 0.06);
            const Vec3 up = (Vec3::UnitY() + random.vector(0.5)).normalized();
            hand.wrist_bs() = wrist_with_palm_at(rig, {0.0, y, 0.0}, up);
        }
        hand.frame(k_dt_s);
        const PalmOffset& now = hand.offset.at(k_right);
        const double step_m =
            way_m(now.shown_m - before.shown_m, now.shown_turn_rad - before.shown_turn_rad);
        const double left_m =
            way_m(now.target_m - now.shown_m, now.target_turn_rad - now.shown_turn_rad);
        const double share_m = (step_m + left_m) / (1.0 + k_palm_settle_s / k_dt_s);
        EXPECT_LE(step_m, std::max(tuning.rate_mps * k_dt_s, share_m) + 1e-3) << frame;
        before = now;
    }
    for (int frame = 0; frame < 200; ++frame) {
        hand.frame(k_dt_s);
    }
    EXPECT_LT((hand.offset.at(k_right).shown_m - hand.offset.at(k_right).target_m).norm(), 1e-12);
}

// Fingers that close while the palm is far from its target close inside the surface.
TEST_F(ShownHand, PalmArrivesInATenthOfASecond) {
    Random random(2107);
    for (int i = 0; i < 100; ++i) {
        const Vec3 up = (Vec3::UnitY() + random.vector(0.5)).normalized();
        FittedHand hand(floor, wrist_with_palm_at(rig, {0.0, -0.03, 0.0}, up));
        for (int frame = 0; frame < 9; ++frame) {
            hand.frame(k_dt_s);
        }
        const PalmOffset& offset = hand.offset.at(k_right);
        EXPECT_GT(offset.target_m.norm(), 0.015) << i;
        EXPECT_LT((offset.target_m - offset.shown_m).norm(), 0.2 * offset.target_m.norm()) << i;
    }
}

TEST_F(ShownHand, EmptyHandReturnsToTrackedPose) {
    FittedHand hand(floor, wrist_with_palm_at(rig, {0.0, -0.02, 0.0}, Vec3::UnitY()));
    hand.frame(k_unlimited_s);
    EXPECT_GT(hand.offset.at(k_right).shown_m.norm(), 0.01);
    let_go(hand);
    double offset_m = hand.offset.at(k_right).shown_m.norm();
    while (offset_m > 0.0) {
        hand.frame(k_dt_s);
        ASSERT_LT(hand.offset.at(k_right).shown_m.norm(), offset_m);
        offset_m = hand.offset.at(k_right).shown_m.norm();
    }
    EXPECT_EQ(hand.palm.at(k_right).pose_ws.position, hand.wrist_bs().position);
}

TEST_F(ShownHand, EmptyHandClosesAsFarAsItsButton) {
    FittedHand hand(beam, {});
    let_go(hand);
    hand.frame(k_unlimited_s);
    const FingerPose rest = hand.pose();
    hand.tracking.at(k_right).pressed = true;
    hand.frame(k_unlimited_s);
    const FingerPose fist = hand.pose();
    hand.tracking.at(k_right).pressed = false;
    Random random(2103);
    for (int i = 0; i < 100; ++i) {
        const double squeeze = random.between(0.0, 1.0);
        hand.tracking.at(k_right).squeeze = squeeze;
        hand.frame(k_unlimited_s);
        for (std::size_t f = 0; f < rig.fingers.size(); ++f) {
            for (std::size_t link = 0; link < rig.fingers[f].link_count; ++link) {
                const double open_rad = rest.shown[f].curl_rad[link];
                const double wanted_rad =
                    open_rad + squeeze * (fist.shown[f].curl_rad[link] - open_rad);
                EXPECT_NEAR(hand.pose().shown[f].curl_rad[link], wanted_rad, 1e-12);
            }
        }
    }
}

TEST_F(ShownHand, TriggerBendsIndexFingerOfEmptyHandOnly) {
    FittedHand hand(beam, {});
    let_go(hand);
    const auto curls = [&](double squeeze, double trigger) {
        hand.tracking.at(k_right).squeeze = squeeze;
        hand.tracking.at(k_right).trigger = trigger;
        hand.frame(k_unlimited_s);
        std::array<double, k_finger_count> sum_rad = {};
        for (std::size_t f = 0; f < rig.fingers.size(); ++f) {
            const auto& curl_rad = hand.pose().shown[f].curl_rad;
            sum_rad[static_cast<std::size_t>(rig.fingers[f].name)] =
                curl_rad[0] + curl_rad[1] + curl_rad[2];
        }
        return sum_rad;
    };
    constexpr auto k_index = static_cast<std::size_t>(FingerName::index);
    const auto rest = curls(0.0, 0.0);
    const auto squeezed = curls(0.6, 0.0);
    auto expected = rest;
    expected[k_index] = squeezed[k_index];
    EXPECT_EQ(curls(0.0, 0.6), expected);
    EXPECT_EQ(curls(0.6, 0.2), squeezed);
}

TEST_F(ShownHand, EmptyHandTakesRestPoseOrFist) {
    FittedHand hand(beam, {});
    let_go(hand);
    hand.frame(k_unlimited_s);
    const FingerPose rest = hand.pose();
    EXPECT_EQ(rest.shown[0].opposition_rad, hand.tuning.thumb.rest_opposition_rad);
    hand.tracking.at(k_right).pressed = true;
    hand.frame(k_unlimited_s);
    for (std::size_t f = 0; f < rig.fingers.size(); ++f) {
        EXPECT_EQ(rest.shown[f].curl_rad, rig.fingers[f].rest_rad);
        for (std::size_t i = 0; i < rig.fingers[f].link_count; ++i) {
            EXPECT_NEAR(hand.pose().shown[f].curl_rad[i], rig.fingers[f].fist.curl_rad[i], 1e-12);
        }
        EXPECT_NEAR(hand.pose().shown[f].opposition_rad, rig.fingers[f].fist.opposition_rad, 1e-12);
    }
}

// Hands at random, 4 to 6 cm before a floor, whose palm is turned away from it by more than 75
// degrees. They have nothing to grip: they close to a fist that touches the floor, whatever their
// button and their curls say.
TEST_F(ShownHand, GrippingHandWithItsBackOrEdgeToASurfaceIsAFist) {
    Random random(2104);
    int above_floor = 0;
    for (int i = 0; i < 2000; ++i) {
        const double height_m = random.between(0.04, 0.06);
        Vec3 up = random.direction();
        while (up.y() > 0.25) {
            up = random.direction();
        }
        FittedHand hand(floor, wrist_with_palm_at(rig, {0.0, height_m, 0.0}, up));
        hand.tracking.at(k_right).squeeze = random.between(0.0, 1.0);
        hand.tracking.at(k_right).pressed = random.between(0.0, 1.0) < 0.5;
        hand.frame(k_unlimited_s);
        ASSERT_EQ(hand.surface.at(k_right).triangle, GripSurface::k_none);
        const double tracked_m = lowest_skin_m(hand, hand.wrist_bs());
        above_floor += tracked_m > 0.01 ? 1 : 0;
        if (tracked_m > 0.0) {
            EXPECT_NEAR(lowest_skin_m(hand, hand.shown_bs()), 0.0, 1e-9) << i;
        } else {
            EXPECT_GE(hand.shown_bs().position.y(), hand.wrist_bs().position.y()) << i;
        }
        for (std::size_t f = 0; f < rig.fingers.size(); ++f) {
            EXPECT_EQ(hand.pose().shown[f].curl_rad, rig.fingers[f].fist.curl_rad);
            EXPECT_EQ(hand.pose().shown[f].opposition_rad, rig.fingers[f].fist.opposition_rad);
        }
    }
    EXPECT_GT(above_floor, 200);
}

// A hand without a surface keeps that result until it has moved.
TEST_F(ShownHand, HandWithoutASurfaceSearchesOnce) {
    FittedHand hand(floor, wrist_with_palm_at(rig, {0.0, 0.04, 0.0}, -Vec3::UnitY()));
    for (int frame = 0; frame < 10; ++frame) {
        hand.frame(k_dt_s);
    }
    EXPECT_EQ(test::count_of(hand.stats, Fallback::palm_no_surface), 1U);
    hand.wrist_bs() = wrist_with_palm_at(rig, {0.0, 0.02, 0.0}, Vec3::UnitY());
    hand.frame(k_dt_s);
    EXPECT_NE(hand.surface.at(k_right).triangle, GripSurface::k_none);
}

}  // namespace
}  // namespace handhold::shown_hand_test

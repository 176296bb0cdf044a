#include "systems/hand/constrain_palms.hpp"

#include <gtest/gtest.h>

#include "fitted_hand.hpp"
#include "systems/hand/shared/palm_fit.hpp"
#include "tests/engine/collision/scene.hpp"

namespace handhold::constrain_palms_test {
namespace {

using test::FittedHand;
using test::k_right;
using test::wrist_with_palm_at;

// Palms face down over a floor in the plane y = 0. The palm's capsules extend below its centre by
// less than the minimum height, so level palms need no depenetration.
struct ConstrainPalms : testing::Test {
    GripMesh floor = build_grip_mesh(test::make_floor_mesh());
    const HandRig rig = builtin_hand_rig(HandSide::right);

    static double tilt_rad(FittedHand& hand) {
        return std::acos(std::min(1.0, hand.palm_up_bs().y()));
    }
    void hold(FittedHand& hand) const {
        hand.search();
        hand.constrain();
    }
};

TEST_F(ConstrainPalms, RaisesPenetratingPalmToMinHeightAlongNormal) {
    FittedHand hand(floor, wrist_with_palm_at(rig, {0.013, -0.02, 0.007}, Vec3::UnitY()));
    hold(hand);
    // At least the minimum height; the heel and the ball of the thumb may need more.
    EXPECT_GE(hand.palm_center_bs().y(), hand.tuning.palm.min_height_m - 1e-9);
    EXPECT_LE(hand.palm_center_bs().y(), hand.tuning.palm.max_height_m);
    EXPECT_NEAR(hand.palm_center_bs().x(), 0.013, 1e-5);
    EXPECT_NEAR(hand.palm_center_bs().z(), 0.007, 1e-5);
    EXPECT_LT(tilt_rad(hand), 0.02);
}

// A tilted palm with penetrating knuckles turns onto the floor. Translation alone would have to
// move it by their whole depth.
TEST_F(ConstrainPalms, TurnsTiltedPalmOutOfPenetration) {
    const Vec3 up = rotation_about(Vec3::UnitX(), 0.4) * Vec3::UnitY();
    FittedHand hand(floor, wrist_with_palm_at(rig, {0.013, 0.005, 0.007}, up));
    const Pose tracked = hand.wrist_bs();
    double deepest_m = 0.0;
    for (const PalmCapsule& capsule : rig.palm) {
        for (const Vec3& end_hs : {capsule.a_hs, capsule.b_hs}) {
            const double height_m = transform_point(tracked, end_hs).y();
            deepest_m = std::max(deepest_m, capsule.radius_m - height_m);
        }
    }
    ASSERT_GT(deepest_m, 0.01);
    hold(hand);
    for (const PalmCapsule& capsule : rig.palm) {
        for (const Vec3& end_hs : {capsule.a_hs, capsule.b_hs}) {
            EXPECT_GT(transform_point(hand.shown_bs(), end_hs).y(), capsule.radius_m - 1e-4);
        }
    }
    const Vec3 center = transform_point(tracked, rig.palm_center_hs);
    EXPECT_LT((hand.palm_center_bs() - center).norm(), 0.5 * deepest_m);
    EXPECT_LT(tilt_rad(hand), 0.4);
}

TEST_F(ConstrainPalms, DepenetratedPalmStaysWithinTiltLimit) {
    test::Random random(2103);
    int turned = 0;
    for (int i = 0; i < 150; ++i) {
        Mesh mesh = test::make_floor_mesh();
        for (Vec3& position : mesh.positions) {  // blocks of 5 cm with random heights
            const bool is_block = static_cast<int>(std::floor(position.x() / 0.05) +
                                                   3.0 * std::floor(position.z() / 0.05) + i) %
                                      3 ==
                                  0;
            position.y() = is_block ? random.between(0.0, 0.05) : 0.0;
        }
        const GripMesh grip = build_grip_mesh(mesh);
        const Vec3 up = (Vec3::UnitY() + random.vector(0.7)).normalized();
        const double height_m = random.between(-0.02, 0.04);
        const Vec3 center = Vec3(0.0, height_m, 0.0) + random.vector(0.03);
        FittedHand hand(grip, wrist_with_palm_at(rig, center, up));
        hold(hand);
        const GripSurface& surface = hand.surface.at(k_right);
        const double cosine = std::clamp(hand.palm_up_bs().dot(surface.normal_bs), -1.0, 1.0);
        EXPECT_LE(std::acos(cosine), hand.tuning.palm.max_angle_rad + 1e-6) << i;
        turned += hand.offset.at(k_right).held_turn_rad.norm() > 0.05 ? 1 : 0;
    }
    EXPECT_GT(turned, 50);
}

TEST_F(ConstrainPalms, LowersHighPalmToMaxHeight) {
    FittedHand hand(floor, wrist_with_palm_at(rig, {0.013, 0.06, 0.007}, Vec3::UnitY()));
    hold(hand);
    EXPECT_NEAR(hand.palm_center_bs().y(), hand.tuning.palm.max_height_m, 1e-9);
    EXPECT_NEAR(hand.palm_center_bs().x(), 0.013, 1e-9);
}

TEST_F(ConstrainPalms, LeavesPalmWithinLimitsAtTrackedPose) {
    const Vec3 up = rotation_about(Vec3::UnitZ(), 0.1) * Vec3::UnitY();
    FittedHand hand(floor, wrist_with_palm_at(rig, {0.013, 0.0149, 0.007}, up));
    hold(hand);
    EXPECT_EQ(hand.offset.at(k_right).held_m, Vec3::Zero());
    EXPECT_LT(hand.offset.at(k_right).held_turn_rad.norm(), 1e-12);
}

TEST_F(ConstrainPalms, ReducesTiltToItsLimitAndKeepsHeight) {
    for (const double tilt : {0.3, 0.5, 0.6}) {
        const Vec3 up = rotation_about(Vec3::UnitZ(), tilt) * Vec3::UnitY();
        FittedHand hand(floor, wrist_with_palm_at(rig, {0.013, 0.05, 0.007}, up));
        hand.tuning.palm.max_height_m = 0.05;  // clearance for a tilted palm
        hold(hand);
        EXPECT_NEAR(tilt_rad(hand), std::min(tilt, hand.tuning.palm.max_angle_rad), 1e-6);
        EXPECT_NEAR(hand.palm_center_bs().y(), 0.05, 1e-9);
    }
}

TEST_F(ConstrainPalms, HandTrackedAtItsHeldPoseStaysThere) {
    test::Random random(2101);
    for (int i = 0; i < 100; ++i) {
        const Vec3 up = (Vec3::UnitY() + random.vector(0.6)).normalized();
        const Vec3 center = {0.0, random.between(-0.02, 0.05), 0.0};
        FittedHand hand(floor, wrist_with_palm_at(rig, center + random.vector(0.01), up));
        hold(hand);
        const Pose held = hand.shown_bs();
        hand.wrist_bs() = held;
        hand.constrain();
        EXPECT_LT(hand.offset.at(k_right).held_m.norm(), 1e-4) << i;
        EXPECT_LT(hand.offset.at(k_right).held_turn_rad.norm(), 1e-3) << i;
    }
}

}  // namespace
}  // namespace handhold::constrain_palms_test

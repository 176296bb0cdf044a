#include "engine/anim/two_bone_ik.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace handhold::two_bone_ik_test {
namespace {

TEST(TwoBoneIk, BonesKeepLengthsIfTipIsInReach) {
    for (double distance = 0.03; distance < 0.58; distance += 0.01) {
        const TwoBoneIk ik{0.30, 0.28, Vec3(1.0, 2.0, 3.0), Vec3(1.0, 2.0, 3.0 - distance),
                           Vec3::UnitX()};
        const Vec3 joint = solve_two_bone_ik(ik);
        EXPECT_NEAR((joint - ik.root).norm(), 0.30, 1e-12);
        EXPECT_NEAR((joint - ik.tip).norm(), 0.28, 1e-12);
        EXPECT_GT((joint - ik.root).dot(ik.bend), 0.0);
        EXPECT_NEAR((joint - ik.root).y(), 0.0, 1e-15);
    }
}

TEST(TwoBoneIk, RightAngleIsPythagoras) {
    const TwoBoneIk ik{3.0, 4.0, Vec3::Zero(), Vec3(5.0, 0.0, 0.0), Vec3::UnitY()};
    // Foot of the altitude of a 3-4-5 triangle: 9/5 along, 12/5 aside.
    EXPECT_LT((solve_two_bone_ik(ik) - Vec3(1.8, 2.4, 0.0)).norm(), 1e-14);
}

TEST(TwoBoneIk, StretchesBothBonesByEqualFactorBeyondReach) {
    const TwoBoneIk ik{0.3, 0.2, Vec3::Zero(), Vec3(0.0, 0.0, -2.0), Vec3::UnitX()};
    EXPECT_LT((solve_two_bone_ik(ik) - Vec3(0.0, 0.0, -1.2)).norm(), 1e-14);
}

TEST(TwoBoneIk, ContinuousInDistance) {
    Vec3 before = Vec3::Zero();
    for (int i = 0; i <= 40000; ++i) {
        const double distance = 1.6e-5 * i;
        const Vec3 joint =
            solve_two_bone_ik({0.30, 0.28, Vec3::Zero(), Vec3(distance, 0.0, 0.0), Vec3::UnitY()});
        ASSERT_TRUE(is_finite(joint));
        // At full reach the height falls like a square root. At zero distance the joint swings
        // around the nearer bone.
        if (i > 1) {
            ASSERT_LT((joint - before).norm(), 0.02) << distance;
        }
        before = joint;
    }
}

}  // namespace
}  // namespace handhold::two_bone_ik_test

#include "engine/anim/crawler_leg.hpp"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

namespace handhold::crawler_leg_test {
namespace {

constexpr CrawlerGait k_gait = {1.25, 0.6, 0.3};

// A torso 0.9 m above the plane y = 0 on a circle, making one full turn.
PosePath torso_path() {
    std::array<Pose, 8> poses;
    for (std::size_t i = 0; i < poses.size(); ++i) {
        const Quat turn =
            rotation_about(Vec3::UnitY(), 0.78539816339744830962 * static_cast<double>(i));
        poses[i] = {Vec3(0.0, 0.9, 0.0) + turn * Vec3(5.0, 0.0, 0.0), turn};
    }
    return make_pose_path(poses, 60.0);
}

CrawlerLeg leg() {
    CrawlerLeg made;
    made.hip_bs = Vec3(0.5, 0.0, 0.3);
    made.foot_bs = Vec3(1.2, -0.9, 0.3);
    made.knee_bs = Vec3(0.5, 1.0, 0.0);
    made.upper_m = 0.8;
    made.lower_m = 0.9;
    made.phase = 0.3;
    return made;
}

TEST(PlaceTwoBones, KeepsLengthsAndReachesTarget) {
    for (const Vec3& target : {Vec3(1.0, 0.2, -0.4), Vec3(0.0, -1.2, 0.1), Vec3(-0.3, 0.2, 0.1)}) {
        const TwoBones bones =
            place_two_bones(Vec3(0.1, 0.2, 0.3), target, 0.8, 0.9, Vec3(1, 2, 3));
        EXPECT_LT((bones.end - target).norm(), 1e-14);
        EXPECT_NEAR((bones.middle - bones.root).norm(), 0.8, 1e-14);
        EXPECT_NEAR((bones.end - bones.middle).norm(), 0.9, 1e-14);
        EXPECT_GT((bones.middle - 0.5 * (bones.root + bones.end)).dot(Vec3(1, 2, 3)), 0.0);
    }
}

TEST(PlaceTwoBones, ThreeFourFiveTriangleHasRightAngle) {
    const TwoBones bones =
        place_two_bones(Vec3::Zero(), Vec3(5.0, 0.0, 0.0), 3.0, 4.0, Vec3::UnitY());
    EXPECT_LT((bones.middle - Vec3(1.8, 2.4, 0.0)).norm(), 1e-14);
}

TEST(PlaceTwoBones, ClampsTargetOutOfReach) {
    const Vec3 far(0.0, -9.0, 0.0);
    const TwoBones bones = place_two_bones(Vec3::Zero(), far, 0.8, 0.9, Vec3::UnitX());
    EXPECT_LT((bones.end - Vec3(0.0, -1.7 * 0.999, 0.0)).norm(), 1e-12);
    EXPECT_NEAR(bones.middle.norm(), 0.8, 1e-12);
    const TwoBones folded =
        place_two_bones(Vec3::Zero(), Vec3(0.0, -0.01, 0.0), 0.8, 0.9, Vec3::UnitX());
    EXPECT_NEAR(folded.end.norm(), 0.1 + 1.7e-3, 1e-12);
    EXPECT_TRUE(is_finite(place_two_bones(far, far, 0.8, 0.9, Vec3::UnitX()).middle));
}

TEST(CrawlerFoot, StandsStillThenSwingsToNextFoothold) {
    const PosePath torso = torso_path();
    for (int step = 0; step < 60; ++step) {
        const double from_s = (step - leg().phase) * k_gait.step_s;
        const double until_s = from_s + k_gait.standing * k_gait.step_s;
        const Vec3 stands = crawler_foot(torso, k_gait, leg(), 0.5 * (from_s + until_s));
        EXPECT_NEAR(stands.y(), 0.0, 1e-9);
        for (const double share : {0.001, 0.3, 0.7, 0.999}) {
            const double t_s = from_s + share * (until_s - from_s);
            EXPECT_EQ(crawler_foot(torso, k_gait, leg(), t_s), stands);
        }
        // Mid-swing: half way, raised by lift_m.
        const double next_s = from_s + k_gait.step_s;
        const Vec3 next = crawler_foot(torso, k_gait, leg(), next_s + 0.01);
        const Vec3 middle = crawler_foot(torso, k_gait, leg(), 0.5 * (until_s + next_s));
        EXPECT_LT((middle - 0.5 * (stands + next) - k_gait.lift_m * Vec3::UnitY()).norm(), 1e-9);
    }
}

TEST(CrawlerFoot, StandsBelowTorsoPoseAtMidStance) {
    const PosePath torso = torso_path();
    const double middle_s = (7.0 - leg().phase + 0.5 * k_gait.standing) * k_gait.step_s;
    const Vec3 expected = transform_point(evaluate(torso, middle_s).pose, leg().foot_bs);
    EXPECT_LT((crawler_foot(torso, k_gait, leg(), middle_s) - expected).norm(), 1e-12);
}

TEST(CrawlerFoot, SpeedAndAccelerationAreBounded) {
    const PosePath torso = torso_path();
    constexpr double k_step_s = 1e-3;
    Vec3 last = crawler_foot(torso, k_gait, leg(), 0.0);
    Vec3 last_velocity = (crawler_foot(torso, k_gait, leg(), k_step_s) - last) / k_step_s;
    for (double t_s = k_step_s; t_s < 20.0; t_s += k_step_s) {
        const Vec3 foot = crawler_foot(torso, k_gait, leg(), t_s);
        const Vec3 velocity = (foot - last) / k_step_s;
        // Swings of 0.5 m with 0.3 m lift in half a second stay below 4 m/s and 60 m/s^2.
        ASSERT_LT(velocity.norm(), 4.0) << t_s;
        ASSERT_LT((velocity - last_velocity).norm() / k_step_s, 60.0) << t_s;
        last = foot;
        last_velocity = velocity;
    }
}

TEST(CrawlerBones, JoinAtKneeAndHip) {
    const PosePath torso = torso_path();
    for (double t_s = -3.0; t_s < 30.0; t_s += 0.137) {
        const Pose upper = crawler_bone_pose(torso, k_gait, leg(), LegBone::upper, t_s);
        const Pose lower = crawler_bone_pose(torso, k_gait, leg(), LegBone::lower, t_s);
        const Vec3 hip = transform_point(upper, Vec3(0.0, 0.4, 0.0));
        const Vec3 knee = transform_point(upper, Vec3(0.0, -0.4, 0.0));
        EXPECT_LT((hip - transform_point(evaluate(torso, t_s).pose, leg().hip_bs)).norm(), 1e-9);
        EXPECT_LT((knee - transform_point(lower, Vec3(0.0, 0.45, 0.0))).norm(), 1e-9);
        EXPECT_LT((transform_point(lower, Vec3(0.0, -0.45, 0.0)) -
                   crawler_foot(torso, k_gait, leg(), t_s))
                      .norm(),
                  1e-9);
    }
}

}  // namespace
}  // namespace handhold::crawler_leg_test

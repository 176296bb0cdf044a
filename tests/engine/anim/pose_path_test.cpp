#include "engine/anim/pose_path.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "engine/core/check.hpp"

namespace handhold::pose_path_test {
namespace {

double angle_between(const Quat& a, const Quat& b) {
    return rotation_to_vector(a * b.conjugate()).norm();
}

std::vector<Pose> random_poses(std::uint64_t seed) {
    std::mt19937_64 engine(seed);
    const auto between = [&engine](double low, double high) {
        return low + (high - low) * static_cast<double>(engine() >> 11) * 0x1p-53;
    };
    std::vector<Pose> poses(2 + engine() % (k_max_path_keys - 1));
    for (Pose& pose : poses) {
        for (int axis = 0; axis < 3; ++axis) {
            pose.position[axis] = between(-5.0, 5.0);
        }
        // Within 1 rad of one rotation, so within 2 rad of each other.
        const double yaw = between(-0.5, 0.5);
        const double pitch = between(-0.4, 0.4);
        pose.rotation =
            rotation_about(Vec3::UnitY(), yaw + 2.0) * rotation_about(Vec3::UnitX(), pitch);
    }
    return poses;
}

RC_GTEST_PROP(PosePath, PassesPosesAtEqualTimeSteps, (std::uint64_t seed)) {
    const std::vector<Pose> poses = random_poses(seed);
    const double period_s = 7.0;
    const PosePath path = make_pose_path(poses, period_s);
    for (std::size_t i = 0; i < poses.size(); ++i) {
        const double t_s = period_s * static_cast<double>(i) / static_cast<double>(poses.size());
        const Pose pose = evaluate(path, t_s).pose;
        RC_ASSERT((pose.position - poses[i].position).norm() < 1e-12);
        RC_ASSERT(angle_between(pose.rotation, poses[i].rotation) < 1e-12);
    }
}

// Central differences with step h have an error of h^2 / 6 times the third derivative, here below
// 1e-6.
RC_GTEST_PROP(PosePath, VelocityIsDerivativeOfPose, (std::uint64_t seed)) {
    const PosePath path = make_pose_path(random_poses(seed), 9.0);
    constexpr double k_step_s = 1e-5;
    for (double t_s = 0.05; t_s < 9.0; t_s += 0.311) {
        const PosePathState state = evaluate(path, t_s);
        const Pose before = evaluate(path, t_s - k_step_s).pose;
        const Pose after = evaluate(path, t_s + k_step_s).pose;
        const Vec3 velocity = (after.position - before.position) / (2.0 * k_step_s);
        const Vec3 spin =
            rotation_to_vector(after.rotation * before.rotation.conjugate()) / (2.0 * k_step_s);
        RC_ASSERT((state.velocity_mps - velocity).norm() < 1e-6);
        RC_ASSERT((state.angular_velocity_radps - spin).norm() < 1e-6);
        RC_ASSERT(std::abs(state.pose.rotation.norm() - 1.0) < 1e-14);
    }
}

RC_GTEST_PROP(PosePath, VelocityAndAccelerationAreContinuousAtKeys, (std::uint64_t seed)) {
    const std::vector<Pose> poses = random_poses(seed);
    const double period_s = static_cast<double>(poses.size());
    const PosePath path = make_pose_path(poses, period_s);
    constexpr double k_step_s = 1e-6;
    for (std::size_t i = 0; i < poses.size(); ++i) {
        const double key_s = static_cast<double>(i);
        const auto velocity = [&](double t_s) { return evaluate(path, t_s).velocity_mps; };
        const Vec3 before = (velocity(key_s - k_step_s) - velocity(key_s - 2.0 * k_step_s));
        const Vec3 after = (velocity(key_s + 2.0 * k_step_s) - velocity(key_s + k_step_s));
        RC_ASSERT((velocity(key_s + k_step_s) - velocity(key_s - k_step_s)).norm() < 1e-3);
        RC_ASSERT((after - before).norm() / k_step_s < 1e-3);
    }
}

TEST(PosePath, EveryLapIsEqual) {
    const PosePath path = make_pose_path(random_poses(4), 8.0);  // a power of two: laps are exact
    for (const double t_s : {0.25, 1.75, 5.5}) {
        const PosePathState once = evaluate(path, t_s);
        for (const double lap : {-3.0, 1.0, 1000.0}) {
            const PosePathState again = evaluate(path, t_s + 8.0 * lap);
            EXPECT_EQ(again.pose.position, once.pose.position);
            EXPECT_EQ(again.pose.rotation.coeffs(), once.pose.rotation.coeffs());
            EXPECT_EQ(again.velocity_mps, once.velocity_mps);
        }
    }
}

// Circle of radius r with the heading along it. A spline through 16 points deviates by at most 5 /
// 384 (2 pi / 16)^4 r (Hall 1968).
TEST(PosePath, FollowsCircleWithFullTurn) {
    constexpr double k_radius_m = 4.0;
    constexpr double k_period_s = 20.0;
    std::array<Pose, 16> poses;
    for (std::size_t i = 0; i < poses.size(); ++i) {
        const double angle = 2.0 * k_pi * static_cast<double>(i) / 16.0;
        poses[i].position = k_radius_m * Vec3(std::cos(angle), 0.0, -std::sin(angle));
        // -Z along the direction of motion.
        poses[i].rotation = rotation_about(Vec3::UnitY(), angle);
    }
    const PosePath path = make_pose_path(poses, k_period_s);
    const double bound_m = k_radius_m * 5.0 / 384.0 * std::pow(2.0 * k_pi / 16.0, 4);
    for (double t_s = 0.0; t_s < 2.0 * k_period_s; t_s += 0.173) {
        const double angle = 2.0 * k_pi * t_s / k_period_s;
        const PosePathState state = evaluate(path, t_s);
        const Vec3 on_circle = k_radius_m * Vec3(std::cos(angle), 0.0, -std::sin(angle));
        EXPECT_LT((state.pose.position - on_circle).norm(), bound_m) << t_s;
        EXPECT_LT(angle_between(state.pose.rotation, rotation_about(Vec3::UnitY(), angle)), 1e-3);
        EXPECT_NEAR(state.angular_velocity_radps.y(), 2.0 * k_pi / k_period_s, 1e-3);
    }
}

TEST(PosePath, IndependentOfQuaternionSigns) {
    std::vector<Pose> poses = random_poses(11);
    const PosePath path = make_pose_path(poses, 5.0);
    for (std::size_t i = 0; i < poses.size(); i += 2) {
        poses[i].rotation.coeffs() = -poses[i].rotation.coeffs();
    }
    const PosePath other = make_pose_path(poses, 5.0);
    for (double t_s = 0.0; t_s < 5.0; t_s += 0.1) {
        EXPECT_LT(
            angle_between(evaluate(path, t_s).pose.rotation, evaluate(other, t_s).pose.rotation),
            1e-12);
    }
}

TEST(PosePath, RejectsInvalidPaths) {
    const std::vector<Pose> one(1);
    const std::vector<Pose> two(2);
    const std::vector<Pose> many(k_max_path_keys + 1);
    EXPECT_THROW(make_pose_path(one, 1.0), PreconditionError);
    EXPECT_THROW(make_pose_path(many, 1.0), PreconditionError);
    EXPECT_THROW(make_pose_path(two, 0.0), PreconditionError);
    EXPECT_THROW(make_pose_path(two, std::numeric_limits<double>::infinity()), PreconditionError);
    std::vector<Pose> turned(2);
    turned[1].rotation = rotation_about(Vec3::UnitX(), 1.01 * k_max_path_turn_rad);
    EXPECT_THROW(make_pose_path(turned, 1.0), PreconditionError);
    EXPECT_THROW(evaluate(PosePath{}, 0.0), PreconditionError);
}

}  // namespace
}  // namespace handhold::pose_path_test

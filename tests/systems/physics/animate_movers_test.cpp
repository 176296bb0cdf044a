#include "systems/physics/animate_movers.hpp"

#include <array>
#include <cmath>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tests/systems/frame/column_scene.hpp"

namespace handhold::animate_movers_test {
namespace {

using test::distance;
using test::entity;
using test::Random;

Mover random_mover(Random& random) {
    return {random.pose(), random.vector(3.0), random.vector(2.0), random.between(0.0, 1.0) < 0.5};
}

TEST(MoverPose, WithoutSpinMovesByVelocityTimesTime) {
    const Mover mover{{Vec3(1.0, 2.0, 3.0), rotation_about(Vec3::UnitX(), 0.3)},
                      Vec3(0.5, 0.0, -1.0),
                      Vec3::Zero(),
                      true};
    const Pose pose = mover_pose(mover, 4.0);
    EXPECT_LT((pose.position - Vec3(3.0, 2.0, -1.0)).norm(), 1e-14);
    EXPECT_EQ(pose.rotation.coeffs(), mover.start_ws.rotation.coeffs());
}

TEST(MoverPose, SpinWithFixedVelocityMovesStraight) {
    const Mover mover{{}, Vec3(1.0, 0.0, 0.0), Vec3(0.0, 0.5, 0.0), false};
    const Pose pose = mover_pose(mover, 2.0);
    EXPECT_LT((pose.position - Vec3(2.0, 0.0, 0.0)).norm(), 1e-14);
    EXPECT_LT(test::angle_between(pose.rotation, rotation_about(Vec3::UnitY(), 1.0)), 1e-14);
    EXPECT_EQ(mover_velocity(mover, 2.0).linear_mps, Vec3(1.0, 0.0, 0.0));
}

// Moving forward (-z) at v while turning left (about +y) at w: a circle of radius v / w with its
// centre on the left (-x).
TEST(MoverPose, RotatingVelocityMovesOnACircleOfRadiusSpeedOverSpin) {
    constexpr double k_speed = 3.0;
    constexpr double k_spin = 0.75;
    constexpr double k_radius = k_speed / k_spin;
    const Mover mover{{}, Vec3(0.0, 0.0, -k_speed), Vec3(0.0, k_spin, 0.0), true};
    for (double t_s = 0.0; t_s < 20.0; t_s += 0.37) {
        const double angle = k_spin * t_s;
        const Vec3 expected(-k_radius * (1.0 - std::cos(angle)), 0.0, -k_radius * std::sin(angle));
        EXPECT_LT((mover_pose(mover, t_s).position - expected).norm(), 1e-13) << t_s;
    }
    EXPECT_LT(mover_pose(mover, 2.0 * k_pi / k_spin).position.norm(), 1e-13);
}

RC_GTEST_PROP(MoverPose, EqualsTheIntegralOfItsVelocity, (std::uint64_t seed)) {
    Random random(seed);
    const Mover mover = random_mover(random);
    const double end_s = random.between(0.1, 5.0);
    // Simpson's rule over 200 steps: error below (w h)^4 v t / 180, about 1e-6 here at worst.
    constexpr int k_steps = 200;
    const double h = end_s / k_steps;
    Vec3 position = mover.start_ws.position;
    for (int i = 0; i < k_steps; ++i) {
        const double t_s = h * i;
        position += (h / 6.0) * (mover_velocity(mover, t_s).linear_mps +
                                 4.0 * mover_velocity(mover, t_s + 0.5 * h).linear_mps +
                                 mover_velocity(mover, t_s + h).linear_mps);
    }
    RC_ASSERT((mover_pose(mover, end_s).position - position).norm() < 2e-6);
}

RC_GTEST_PROP(MoverPose, RotatesAtItsAngularVelocity, (std::uint64_t seed)) {
    Random random(seed);
    const Mover mover = random_mover(random);
    const double t_s = random.between(0.0, 100.0);
    constexpr double k_step_s = 1e-3;
    const Quat turn =
        mover_pose(mover, t_s + k_step_s).rotation * mover_pose(mover, t_s).rotation.conjugate();
    const Vec3 spin = rotation_to_vector(turn) / k_step_s;
    RC_ASSERT((spin - mover.angular_velocity_ws_radps).norm() < 1e-10);
    RC_ASSERT(mover_velocity(mover, t_s).angular_radps == mover.angular_velocity_ws_radps);
}

// Nothing accumulates: two successive motions equal one long motion.
RC_GTEST_PROP(MoverPose, ContinuingFromAnyTimeGivesTheSamePose, (std::uint64_t seed)) {
    Random random(seed);
    const Mover mover = random_mover(random);
    const double first_s = random.between(0.0, 10.0);
    const double second_s = random.between(0.0, 10.0);
    const Mover later{mover_pose(mover, first_s), mover_velocity(mover, first_s).linear_mps,
                      mover.angular_velocity_ws_radps, mover.turns_with_body};
    RC_ASSERT(distance(mover_pose(later, second_s), mover_pose(mover, first_s + second_s)) < 1e-7);
}

RC_GTEST_PROP(MoverPose, TinySpinIsNearlyStraight, (std::uint64_t seed)) {
    Random random(seed);
    for (const double rate : {1e-13, 1e-11, 1e-8, 1e-5}) {
        Mover mover{random.pose(), random.vector(3.0), rate * Vec3(0.6, 0.0, 0.8), true};
        const double t_s = random.between(0.0, 10.0);
        const Vec3 straight = mover.start_ws.position + t_s * mover.velocity_ws_mps;
        // The circle leaves its tangent by v w t^2 / 2.
        const double bend = 0.5 * mover.velocity_ws_mps.norm() * rate * t_s * t_s;
        RC_ASSERT((mover_pose(mover, t_s).position - straight).norm() < 1.001 * bend + 1e-13);
    }
}

struct Movers {
    Column<Mover> mover;
    Column<PathMover> path_mover;
    Column<LegMover> leg_mover;
    Column<MoveTarget> targets;
    Column<BodyPose> body_pose;
    Column<BodyStart> body_start;
    Column<BodyVelocity> velocity;

    void add(Entity entity, const Mover& moved) {
        mover.add(entity, moved);
        body_pose.add(entity, {moved.start_ws});
        body_start.add(entity);
        velocity.add(entity);
    }
    void add_at_rest(Entity entity) {
        body_pose.add(entity);
        body_start.add(entity);
        velocity.add(entity);
    }
    void run(double end_s) {
        animate_movers({.dt_s = 1.0 / 90.0,
                        .end_s = end_s,
                        .mover = mover,
                        .path_mover = path_mover,
                        .leg_mover = leg_mover,
                        .target = targets,
                        .body_pose = body_pose,
                        .body_start = body_start,
                        .velocity = velocity});
    }
};

TEST(AnimateMovers, StartsEachFrameWhereTheLastEnded) {
    Random random(3);
    Movers movers;
    const Mover mover = random_mover(random);
    movers.add(entity(1), mover);
    movers.run(0.01);
    const Pose first = movers.body_pose.at(entity(1)).pose_ws;
    EXPECT_EQ(distance(movers.body_start.at(entity(1)).pose_ws, mover.start_ws), 0.0);
    EXPECT_EQ(distance(first, mover_pose(mover, 0.01)), 0.0);
    movers.run(0.02);
    EXPECT_EQ(distance(movers.body_start.at(entity(1)).pose_ws, first), 0.0);
    EXPECT_EQ(distance(movers.body_pose.at(entity(1)).pose_ws, mover_pose(mover, 0.02)), 0.0);
    EXPECT_EQ(movers.velocity.at(entity(1)).linear_mps, mover_velocity(mover, 0.02).linear_mps);
}

TEST(AnimateMovers, ResultDoesNotDependOnOrderAndOtherBodiesStay) {
    Random random(5);
    const Mover one = random_mover(random);
    const Mover two = random_mover(random);
    Movers forth;
    forth.add(entity(1), one);
    forth.add(entity(2), two);
    Movers back;
    back.add(entity(2), two);
    back.add(entity(1), one);
    back.body_pose.add(entity(3), {Pose{Vec3(7.0, 7.0, 7.0), Quat::Identity()}});
    forth.run(0.5);
    back.run(0.5);
    for (const Entity body : {entity(1), entity(2)}) {
        EXPECT_EQ(distance(forth.body_pose.at(body).pose_ws, back.body_pose.at(body).pose_ws), 0.0);
    }
    EXPECT_EQ(back.body_pose.at(entity(3)).pose_ws.position, Vec3(7.0, 7.0, 7.0));
}

// --- Paths and legs ------------------------------------------------------------------------------

PosePath loop() {
    std::array<Pose, 6> poses;
    for (std::size_t i = 0; i < poses.size(); ++i) {
        const Quat turn = rotation_about(Vec3::UnitY(), k_pi / 3.0 * static_cast<double>(i));
        poses[i] = {turn * Vec3(4.0, 0.0, 0.0) + Vec3(0.0, 0.8, 0.0), turn};
    }
    return make_pose_path(poses, 30.0);
}

LegMover leg_of(Entity torso, LegBone bone) {
    LegMover mover;
    mover.torso = torso;
    mover.leg.hip_bs = Vec3(0.5, 0.0, 0.2);
    mover.leg.foot_bs = Vec3(1.1, -0.8, 0.2);
    mover.leg.upper_m = 0.7;
    mover.leg.lower_m = 0.8;
    mover.bone = bone;
    return mover;
}

TEST(AnimateMovers, PathBodyIsOnItsPathAtTheFramesEnd) {
    Movers movers;
    movers.add_at_rest(entity(1));
    movers.path_mover.add(entity(1), {loop()});
    movers.run(3.7);
    movers.run(3.8);
    const PosePathState expected = evaluate(loop(), 3.8);
    EXPECT_EQ(distance(movers.body_pose.at(entity(1)).pose_ws, expected.pose), 0.0);
    EXPECT_EQ(distance(movers.body_start.at(entity(1)).pose_ws, evaluate(loop(), 3.7).pose), 0.0);
    EXPECT_EQ(movers.velocity.at(entity(1)).linear_mps, expected.velocity_mps);
    EXPECT_EQ(movers.velocity.at(entity(1)).angular_radps, expected.angular_velocity_radps);
}

TEST(AnimateMovers, BonesFollowTheirTorsoInAnyInsertionOrder) {
    Movers movers;
    for (std::uint32_t i = 1; i <= 3; ++i) {
        movers.add_at_rest(entity(i));
    }
    movers.leg_mover.add(entity(1), leg_of(entity(3), LegBone::upper));
    movers.path_mover.add(entity(3), {loop()});
    movers.leg_mover.add(entity(2), leg_of(entity(3), LegBone::lower));
    movers.run(2.3);
    const LegMover lower = leg_of(entity(3), LegBone::lower);
    EXPECT_EQ(distance(movers.body_pose.at(entity(2)).pose_ws,
                       crawler_bone_pose(loop(), lower.gait, lower.leg, LegBone::lower, 2.3)),
              0.0);
    // They meet at the knee.
    const Vec3 knee =
        transform_point(movers.body_pose.at(entity(1)).pose_ws, Vec3(0.0, -0.35, 0.0));
    const Vec3 same = transform_point(movers.body_pose.at(entity(2)).pose_ws, Vec3(0.0, 0.4, 0.0));
    EXPECT_LT((knee - same).norm(), 1e-12);
}

TEST(AnimateMovers, BoneWithoutItsTorsoStops) {
    Movers movers;
    movers.add_at_rest(entity(1));
    movers.add_at_rest(entity(3));
    movers.leg_mover.add(entity(1), leg_of(entity(3), LegBone::upper));
    movers.path_mover.add(entity(3), {loop()});
    movers.run(1.0);
    const Pose last = movers.body_pose.at(entity(1)).pose_ws;
    movers.path_mover.remove(entity(3));
    movers.run(1.1);
    EXPECT_EQ(distance(movers.body_pose.at(entity(1)).pose_ws, last), 0.0);
    EXPECT_EQ(distance(movers.body_start.at(entity(1)).pose_ws, last), 0.0);
    EXPECT_EQ(movers.velocity.at(entity(1)).linear_mps, Vec3(Vec3::Zero()));
}

// Oracle: Richardson extrapolation of two coarser differences, with a fourth-order error.
TEST(AnimateMovers, BoneVelocitiesMatchThePosesDerivativeWithinTheStatedError) {
    for (const LegBone bone : {LegBone::upper, LegBone::lower}) {
        const LegMover mover = leg_of(entity(3), bone);
        for (double t_s = 0.013; t_s < 3.0; t_s += 0.0371) {
            const auto slope = [&](double step_s) {
                const auto at = [&](double time_s) {
                    return crawler_bone_pose(loop(), mover.gait, mover.leg, bone, time_s).position;
                };
                return Vec3((at(t_s + step_s) - at(t_s - step_s)) / (2.0 * step_s));
            };
            // Not across a foot's lift-off or landing, where the third derivative jumps.
            const double share = t_s / mover.gait.step_s - std::floor(t_s / mover.gait.step_s);
            if (share < 0.01 || share > 0.99 || std::abs(share - mover.gait.standing) < 0.01) {
                continue;
            }
            const Vec3 exact = (4.0 * slope(5e-4) - slope(1e-3)) / 3.0;
            EXPECT_LT((leg_velocity(loop(), mover, t_s).linear_mps - exact).norm(), 1e-5) << t_s;
        }
    }
}

}  // namespace
}  // namespace handhold::animate_movers_test

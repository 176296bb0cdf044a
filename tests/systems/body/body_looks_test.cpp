// How bodies look beside a surface below them, and arms beside the trunk.
#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "systems/body/shared/fold_body.hpp"
#include "tests/random.hpp"
#include "tests/systems/body/hanging_body.hpp"

namespace handhold::body_looks_test {
namespace {

using test::HangingBody;
using test::k_player;

// Surfaces 0.45 to 1.1 m below the chest, tilted by up to 14 degrees: feet do not stand beside the
// chest, knees stay bent, and legs stay apart.
TEST(BodyLooks, BodiesLieAlongASurfaceBelow) {
    test::Random random(118);
    for (int i = 0; i < 40; ++i) {
        HangingBody body;
        const double below_m = random.between(0.45, 1.1);
        const double pitch_rad = random.between(-0.25, 0.25);
        const double roll_rad = random.between(-0.25, 0.25);
        const Quat tilt = rotation_from_vector(Vec3(pitch_rad, 0.0, roll_rad));
        const Vec3 up = tilt * Vec3::UnitY();
        body.put_box(Vec3(6.0, 0.5, 6.0), {Vec3(0.0, 1.4 - below_m, 0.0) - 0.5 * up, tilt});
        // The tracked floor is far below.
        body.head.at(k_player).shift_m.y() = -5.0;
        const SpinePose& pose = body.run(4.0);
        const Vec3 chest = pose.chest_ws.position;
        const Vec3 trunk = chest - pose.pelvis_ws.position;
        for (const SpinePose::Leg& leg : pose.legs) {
            EXPECT_LT(trunk.dot(leg.foot_ws.position - chest), 0.0) << i;
            const Vec3 thigh = leg.shin_ws.position - leg.thigh_ws.position;
            const Vec3 shin = leg.foot_ws.position - leg.shin_ws.position;
            EXPECT_GT(arc_tangent2(thigh.cross(shin).norm(), thigh.dot(shin)),
                      k_least_knee_rad - 0.02)
                << i;
        }
    }
}

// The hand and the bones' lengths stay; arms that are outside stay exactly.
TEST(BodyLooks, ElbowsLeaveTheTrunk) {
    test::Random random(119);
    HangingBody body;
    const SpinePose spine = body.run(0.1);
    int inside = 0;
    for (int i = 0; i < 500; ++i) {
        body.arm_pose.at(k_player) = {};
        ArmPose& arms = body.arm_pose.at(k_player);
        for (const double side : {-1.0, 1.0}) {
            ArmPose::Arm& arm = arms.arms[side < 0.0 ? 0 : 1];
            const Vec3 shoulder = spine.chest_ws.position + Vec3(0.19 * side, 0.0, 0.0);
            arm.upper_ws.position = shoulder;
            arm.forearm_ws.position = shoulder + 0.3 * random.direction();
            // Not beyond the trunk: no turn about the arm's line keeps such a forearm outside.
            const double aside_m = side * random.between(0.05, 0.3);
            const double up_m = random.between(-0.4, 0.1);
            const double back_m = random.between(-0.4, -0.25);
            arm.hand_ws.position = shoulder + Vec3(aside_m, up_m, back_m);
        }
        const ArmPose before = arms;
        body.arm_memory.at(k_player) = {};
        body.clear_arms(1.0);
        for (std::size_t side = 0; side < k_hand_count; ++side) {
            const Vec3 was = before.arms[side].forearm_ws.position;
            const Vec3 now = arms.arms[side].forearm_ws.position;
            const Vec3 shoulder = arms.arms[side].upper_ws.position;
            const Vec3 hand = arms.arms[side].hand_ws.position;
            EXPECT_EQ(hand, before.arms[side].hand_ws.position);
            EXPECT_NEAR((now - shoulder).norm(), (was - shoulder).norm(), 1e-9);
            EXPECT_NEAR((now - hand).norm(), (was - hand).norm(), 1e-9);
            inside += now != was ? 1 : 0;
        }
    }
    EXPECT_GT(inside, 50);
}

// Chests that jump and turn, hands that grip and let go, and surfaces that appear below: the shown
// pelvis and feet keep their limits, knees stay bent, and legs stay apart.
TEST(BodyLooks, LegsOfAThrownBodyLookLikeLegs) {
    test::Random random(123);
    int frames = 0;
    int crossed = 0;
    int fast = 0;
    int stopped = 0;
    for (int i = 0; i < 40; ++i) {
        HangingBody body;
        body.head.at(k_player).shift_m.y() = random.between(-0.2, 0.6);
        const double hz = random.between(60.0, 144.0);
        Pose& chest_ps = body.estimate.at(k_player).chest_ps;
        std::array<Vec3, k_hand_count> before = {Vec3::Zero(), Vec3::Zero()};
        std::array<Vec3, k_hand_count> before_mps = before;
        Vec3 pelvis_before = Vec3::Zero();
        for (int frame = 0; frame < static_cast<int>(6.0 * hz); ++frame) {
            if (random.between(0.0, 1.0) < 1.0 / hz) {
                chest_ps.position += random.vector(0.12);
                chest_ps.rotation = rotation_from_vector(random.vector(0.5));
                body.grip(HandSide::left, random.between(0.0, 1.0) < 0.5);
                body.put_hand(HandSide::left, random.vector(0.6));
            }
            if (frame == static_cast<int>(hz)) {
                body.put_box(Vec3(3.0, 0.5, 3.0), {Vec3(0.0, random.between(-0.2, 0.4), 0.0),
                                                   rotation_from_vector(random.vector(0.3))});
            }
            body.step(1.0 / hz);
            body.limit_pelvis(1.0 / hz);
            body.limit_feet(1.0 / hz);
            const SpinePose& pose = body.spine_pose.at(k_player);
            const Vec3 pelvis = pose.pelvis_ws.position - pose.chest_ws.position;
            if (frame > 0) {
                // The pelvis moves on a sphere about the chest, whose radius is not limited.
                const double turned = (pelvis.normalized() - pelvis_before.normalized()).norm();
                const double radius_m = std::min(pelvis.norm(), pelvis_before.norm());
                EXPECT_LT(hz * turned * radius_m, 1.2 * k_pelvis_limits.speed_mps);
            }
            pelvis_before = pelvis;
            const Vec3 right = pose.pelvis_ws.rotation * Vec3::UnitX();
            const Vec3 apart = pose.legs[1].shin_ws.position - pose.legs[0].shin_ws.position;
            ++frames;
            crossed += right.dot(apart) < 0.0 ? 1 : 0;
            for (std::size_t side = 0; side < k_hand_count; ++side) {
                const SpinePose::Leg& leg = pose.legs[side];
                const Vec3 thigh = leg.shin_ws.position - leg.thigh_ws.position;
                const Vec3 shin = leg.foot_ws.position - leg.shin_ws.position;
                ASSERT_GT(arc_tangent2(thigh.cross(shin).norm(), thigh.dot(shin)),
                          k_least_knee_rad - 0.02);
                const Vec3 foot = leg.foot_ws.position - pose.chest_ws.position;
                const Vec3 mps = hz * (foot - before[side]);
                fast += frame > 0 && mps.norm() > 3.0 ? 1 : 0;
                stopped += frame > 1 && (mps - before_mps[side]).norm() > 1.0 ? 1 : 0;
                before[side] = foot;
                before_mps[side] = mps;
            }
        }
    }
    RecordProperty("crossed", crossed);
    RecordProperty("fast", fast);
    RecordProperty("stopped", stopped);
    EXPECT_LT(crossed, frames / 100);
    EXPECT_LT(fast, frames / 500);
    EXPECT_LT(stopped, frames / 500);
}

// An arm whose hand is at `hand`, relative to the shoulder, and whose elbow is `angle_rad` about
// the line between them.
ArmPose::Arm arm_at(const Vec3& shoulder, const Vec3& hand, double angle_rad, const Quat& palm) {
    constexpr double k_bone_m = 0.29;
    const Vec3 axis = hand.normalized();
    const double along_m = 0.5 * hand.norm();
    const double aside_m = std::sqrt(std::max(0.0, k_bone_m * k_bone_m - along_m * along_m));
    const Vec3 down = (-Vec3::UnitY() + axis * axis.y()).normalized();
    ArmPose::Arm arm;
    arm.upper_ws.position = shoulder;
    arm.forearm_ws.position =
        shoulder + along_m * axis + rotation_about(axis, angle_rad) * (aside_m * down);
    arm.hand_ws = {shoulder + hand, palm};
    return arm;
}

double bend_rad(const ArmPose::Arm& arm) {
    const Vec3 forearm = arm.hand_ws.position - arm.forearm_ws.position;
    const Vec3 ahead = arm.hand_ws.rotation * -Vec3::UnitZ();
    return arc_tangent2(forearm.cross(ahead).norm(), forearm.dot(ahead));
}

// Hands beside and before the trunk, elbows anywhere: once the turn has converged, elbows and
// forearms are outside of the trunk, as the lab measures it.
TEST(BodyLooks, ElbowsAndForearmsEndOutsideTheTrunk) {
    constexpr double k_inside_m = 0.11;
    test::Random random(124);
    HangingBody body;
    const SpinePose spine = body.run(0.1);
    const Vec3 chest = spine.chest_ws.position;
    const Vec3 down = spine.pelvis_ws.position - chest;
    int inside = 0;
    constexpr int k_arms = 1000;
    for (int i = 0; i < k_arms; ++i) {
        const double right_m = random.between(0.0, 0.3);
        const double up_m = random.between(-0.4, 0.1);
        const Vec3 hand(right_m, up_m, random.between(-0.4, -0.25));
        ArmPose::Arm& arm = body.arm_pose.at(k_player).arms[1];
        body.arm_memory.at(k_player) = {};
        const double angle_rad = random.between(-2.0, 2.0);
        for (int frame = 0; frame < 30; ++frame) {
            arm = arm_at(chest + Vec3(0.19, 0.0, 0.0), hand, angle_rad,
                         rotation_from_vector(random.vector(0.01)));
            body.clear_arms(1.0 / 90.0);
        }
        for (const double share : {0.0, 0.25, 0.5, 0.75}) {
            const Vec3 elbow = arm.forearm_ws.position;
            const Vec3 from = elbow + share * (arm.hand_ws.position - elbow) - chest;
            const double along = std::clamp(down.dot(from) / down.squaredNorm(), 0.0, 1.0);
            if ((from - along * down).norm() < k_inside_m) {
                ++inside;
                break;
            }
        }
    }
    EXPECT_LT(inside, k_arms / 100);
}

// An elbow wanted in the middle of the trunk, which trembles, stays on its side of it.
TEST(BodyLooks, ElbowsKeepToTheirSideOfTheTrunk) {
    test::Random random(125);
    HangingBody body;
    const Vec3 chest = body.run(0.1).chest_ws.position;
    int changes = 0;
    for (int i = 0; i < 100; ++i) {
        const double right_m = random.between(-0.15, 0.0);
        const double up_m = random.between(-0.35, -0.1);
        const Vec3 hand(right_m, up_m, random.between(-0.3, -0.2));
        const double middle_rad = random.between(-1.5, 1.5);
        body.arm_memory.at(k_player) = {};
        Vec3 before;
        double turn_rad = 0.0;
        for (int frame = 0; frame < 200; ++frame) {
            body.arm_pose.at(k_player).arms[1] =
                arm_at(chest + Vec3(0.19, 0.0, 0.0), hand, middle_rad + random.between(-0.1, 0.1),
                       Quat::Identity());
            body.clear_arms(1.0 / 90.0);
            const Vec3 elbow = body.arm_pose.at(k_player).arms[1].forearm_ws.position;
            if (frame > 30) {
                EXPECT_LT((elbow - before).norm(), 0.1) << i << " " << frame;
                changes += turn_rad * body.arm_memory.at(k_player).arms[1].cleared_rad < 0.0;
            }
            turn_rad = body.arm_memory.at(k_player).arms[1].cleared_rad;
            before = elbow;
        }
    }
    EXPECT_EQ(changes, 0) << "turns to the other side";
}

// Bent wrists away from the trunk: the forearm follows the hand as far as a turn of the elbow can.
TEST(BodyLooks, ForearmsFollowBentWrists) {
    test::Random random(126);
    HangingBody body;
    const Vec3 shoulder = body.run(0.1).chest_ws.position + Vec3(0.19, 0.0, 0.0);
    int followed = 0;
    for (int i = 0; i < 300; ++i) {
        const double right_m = random.between(0.2, 0.3);
        const Vec3 hand(right_m, random.between(0.0, 0.25), -0.3);
        const Quat palm = random.rotation();
        double best_rad = k_pi;
        for (int k = -30; k <= 30; ++k) {
            const double angle_rad = k_most_clear_rad * k / 30.0;
            best_rad = std::min(best_rad, bend_rad(arm_at(shoulder, hand, angle_rad, palm)));
        }
        body.arm_memory.at(k_player) = {};
        ArmPose::Arm& arm = body.arm_pose.at(k_player).arms[1];
        const ArmPose::Arm given = arm_at(shoulder, hand, 0.0, palm);
        for (int frame = 0; frame < 30; ++frame) {
            arm = given;
            body.clear_arms(1.0 / 90.0);
        }
        constexpr double k_near_rad = 0.04;
        EXPECT_LT(bend_rad(arm), std::max(k_wrist_follow_rad, best_rad) + k_near_rad) << i;
        const Vec3 elbow = arm.forearm_ws.position;
        arm = given;
        body.clear_arms(1.0 / 90.0);
        EXPECT_LT((arm.forearm_ws.position - elbow).norm(), 1e-3) << i << ": trembles at rest";
        followed += bend_rad(given) > bend_rad(arm) + 0.1 ? 1 : 0;
    }
    EXPECT_GT(followed, 30);
}

}  // namespace
}  // namespace handhold::body_looks_test

#include "systems/rigs/body_rig.hpp"

#include <gtest/gtest.h>

#include "stick_figure.hpp"
#include "systems/rigs/body_rig_fit.hpp"
#include "tests/engine/allocation_count.hpp"

namespace handhold::body_rig_test {
namespace {

using test::any_pose;
using test::expect_at;
using test::StickFigure;

TEST(PoseSkeleton, PlacesEveryJointAtThePlayersBone) {
    for (unsigned seed = 1; seed < 20; ++seed) {
        const StickFigure sticks(seed % 2 == 0 ? 0.4 : 2.5, 0.6 * seed, seed);
        const Result<BodyRig> rig = fit_body_rig(sticks.figure);
        ASSERT_TRUE(rig.ok()) << rig.error().message();
        const RenderPose render = any_pose(seed);
        SkeletonPose pose;
        pose_skeleton(rig.value(), {}, render, pose);
        const auto at = [&](const std::string& name) {
            return pose.joint_ws[sticks.joint(name)].position;
        };
        for (const HandSide side : {HandSide::left, HandSide::right}) {
            const std::string of = side == HandSide::left ? "Left" : "Right";
            const ArmPose::Arm& arm = render.arms.arms[index_of(side)];
            expect_at(at(of + "Shoulder"), arm.clavicle_ws.position, "clavicle");
            expect_at(at(of + "Arm"), arm.upper_ws.position, "upper arm");
            expect_at(at(of + "ForeArm"), arm.forearm_ws.position, "forearm");
            expect_at(at(of + "Hand"), arm.hand_ws.position, "hand");
            const SpinePose::Leg& leg = render.spine.legs[index_of(side)];
            expect_at(at(of + "UpLeg"), leg.thigh_ws.position, "thigh");
            expect_at(at(of + "Leg"), leg.shin_ws.position, "shin");
            expect_at(at(of + "Foot"), leg.foot_ws.position, "foot");
        }
        expect_at(0.5 * (at("LeftEye") + at("RightEye")), render.head_ws.position, "eyes");
    }
}

// A bone's skin lies along the player's bone, and the elbow's or knee's side in the file is that
// side on the player.
TEST(PoseSkeleton, JointsFollowDirectionAndRollOfThePlayersBones) {
    for (unsigned seed = 1; seed < 20; ++seed) {
        const double yaw = 0.6 * seed;
        const StickFigure sticks(1.4, yaw, seed);
        const Result<BodyRig> rig = fit_body_rig(sticks.figure);
        ASSERT_TRUE(rig.ok()) << rig.error().message();
        const RenderPose render = any_pose(seed);
        SkeletonPose pose;
        pose_skeleton(rig.value(), {}, render, pose);
        const Vec3 back_ms = rotation_about(Vec3::UnitY(), yaw) * Vec3::UnitZ();
        const auto check = [&](const std::string& bone, const std::string& next,
                               const Pose& bone_ws, const Vec3& to_ws, const Vec3& along,
                               const Vec3& back) {
            const Affine& carry = pose.carry_ws[sticks.joint(bone)];
            const Vec3 end_ms = sticks.figure.joints[sticks.joint(next)].bind_ms.position;
            const double length = (to_ws - bone_ws.position).norm();
            expect_at(transform_point(carry, end_ms),
                      transform_point(bone_ws, Vec3(length * along)), bone.c_str());
            const Vec3 turned = (carry.linear * back_ms).normalized();
            EXPECT_NEAR((turned - bone_ws.rotation * back).norm(), 0.0, 1e-9) << bone;
        };
        for (const HandSide side : {HandSide::left, HandSide::right}) {
            const std::string of = side == HandSide::left ? "Left" : "Right";
            const ArmPose::Arm& arm = render.arms.arms[index_of(side)];
            const Vec3 ahead = -Vec3::UnitZ();
            check(of + "Arm", of + "ForeArm", arm.upper_ws, arm.forearm_ws.position, ahead,
                  Vec3::UnitY());
            check(of + "ForeArm", of + "Hand", arm.forearm_ws, arm.hand_ws.position, ahead,
                  Vec3::UnitY());
            const SpinePose::Leg& leg = render.spine.legs[index_of(side)];
            check(of + "UpLeg", of + "Leg", leg.thigh_ws, leg.shin_ws.position, -Vec3::UnitY(),
                  Vec3::UnitZ());
            check(of + "Leg", of + "Foot", leg.shin_ws, leg.foot_ws.position, -Vec3::UnitY(),
                  Vec3::UnitZ());
        }
    }
}

TEST(PoseSkeleton, DoesNotAllocateOnceWarm) {
    if (!counts_allocations()) {
        GTEST_SKIP() << "a sanitizer has operators of its own";
    }
    const Result<BodyRig> rig = fit_body_rig(StickFigure().figure);
    ASSERT_TRUE(rig.ok());
    SkeletonPose pose;
    pose_skeleton(rig.value(), {}, any_pose(1), pose);
    const RenderPose render = any_pose(2);
    const std::size_t before = allocation_count();
    pose_skeleton(rig.value(), {}, render, pose);
    EXPECT_EQ(allocation_count(), before);
}

// The upper arm's skin ends at the forearm's start for any arm length.
TEST(PoseSkeleton, StretchesVerticesFromJointToJoint) {
    const StickFigure sticks(1.3);
    const Result<BodyRig> rig = fit_body_rig(sticks.figure);
    ASSERT_TRUE(rig.ok());
    RenderPose render = any_pose(4);
    ArmPose::Arm& arm = render.arms.arms[index_of(HandSide::right)];
    arm.forearm_ws.position =
        transform_point(arm.upper_ws, Vec3(0.0, 0.0, -0.37));  // along the bone
    SkeletonPose pose;
    pose_skeleton(rig.value(), {}, render, pose);
    const Vec3 elbow_ms = sticks.figure.joints[sticks.joint("RightForeArm")].bind_ms.position;
    expect_at(transform_point(pose.carry_ws[sticks.joint("RightArm")], elbow_ms),
              arm.forearm_ws.position, "the upper arm's end");
}

TEST(PoseSkeleton, LocalPosesComposeToWorldPoses) {
    const StickFigure sticks;
    const Result<BodyRig> rig = fit_body_rig(sticks.figure);
    ASSERT_TRUE(rig.ok());
    SkeletonPose pose;
    pose_skeleton(rig.value(), {}, any_pose(7), pose);
    for (std::size_t i = 0; i < rig.value().joints.size(); ++i) {
        Pose made = pose.joint_ls[i];
        for (std::int32_t at = rig.value().joints[i].parent; at >= 0;
             at = rig.value().joints[static_cast<std::size_t>(at)].parent) {
            made = pose.joint_ls[static_cast<std::size_t>(at)] * made;
        }
        EXPECT_NEAR((made.position - pose.joint_ws[i].position).norm(), 0.0, 1e-12);
        EXPECT_LT(made.rotation.angularDistance(pose.joint_ws[i].rotation), 1e-7);
    }
}

// The rig's hand joint has hand space's axes: -Z to the fingers, +Y out of the back.
TEST(PoseSkeleton, HandJointInHandSpaceEqualsThePlayersHandExactly) {
    StickFigure sticks;
    for (const char* name : {"LeftHand", "RightHand"}) {
        const double out = std::string(name) == "LeftHand" ? -1.0 : 1.0;
        Mat3 axes;
        axes.col(2) = Vec3(-out, 0.0, 0.0);
        axes.col(1) = Vec3::UnitY();
        axes.col(0) = Vec3(axes.col(1)).cross(Vec3(axes.col(2)));
        sticks.figure.joints[sticks.joint(name)].bind_ms.rotation = Quat(axes);
    }
    const Result<BodyRig> rig = fit_body_rig(sticks.figure);
    ASSERT_TRUE(rig.ok());
    SkeletonPose pose;
    for (unsigned seed = 1; seed < 50; ++seed) {
        const RenderPose render = any_pose(seed);
        pose_skeleton(rig.value(), {}, render, pose);
        for (const HandSide side : {HandSide::left, HandSide::right}) {
            const Pose& hand = render.arms.arms[index_of(side)].hand_ws;
            const char* const name = side == HandSide::left ? "LeftHand" : "RightHand";
            const Pose& joint = pose.joint_ws[sticks.joint(name)];
            EXPECT_EQ(joint.position, hand.position);
            EXPECT_EQ(joint.rotation.coeffs(), hand.rotation.coeffs());
        }
    }
}

}  // namespace
}  // namespace handhold::body_rig_test

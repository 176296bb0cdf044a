#include "game/render/robot_body.hpp"

#include <gtest/gtest.h>

#include "components/body_rig_fit.hpp"
#include "game/render/body_figures.hpp"

namespace handhold::robot_body_test {
namespace {

TEST(RobotBody, IsAFigureWithAllBones) {
    const SkinnedMesh body = make_robot_body();
    const Result<BodyRig> rig = fit_body_rig(body);
    ASSERT_TRUE(rig.ok()) << rig.error().message();
    EXPECT_NEAR(rig.value().shoulder_width_m, 0.38, 1e-6);
    // On its soles: the eyes are where it was built for, to the thickness of a sole.
    EXPECT_NEAR(rig.value().eye_height_m, 1.641, 0.01);
    std::array<int, k_body_bone_count> carried{};
    for (const SkinWeights& weights : body.weights) {
        const BodyRig::Joint& joint = rig.value().joints[weights.joint[0]];
        ++carried[static_cast<std::size_t>(rig.value().carriers[joint.carrier].bone)];
    }
    for (std::size_t bone = 0; bone < k_body_bone_count; ++bone) {
        EXPECT_EQ(carried[bone] > 0, static_cast<BodyBone>(bone) != BodyBone::hand) << bone;
    }
    EXPECT_LT(body.triangles.size(), 40000U);
}

TEST(RobotBody, HandsStandInHandSpace) {
    const BodyModel model = builtin_body_model();
    int hands = 0;
    for (const BodyRig::Joint& joint : model.rig.joints) {
        if (model.rig.carriers[joint.carrier].bone == BodyBone::hand) {
            EXPECT_EQ(joint.in_bone.position, Vec3::Zero()) << joint.name;
            EXPECT_EQ(joint.in_bone.rotation.coeffs(), Quat::Identity().coeffs()) << joint.name;
            ++hands;
        }
    }
    EXPECT_EQ(hands, 2);
}

TEST(RobotBody, IsTheSameEachTime) { EXPECT_EQ(make_robot_body_glb(), make_robot_body_glb()); }

// Left is right through x = 0.
TEST(RobotBody, IsSymmetric) {
    const SkinnedMesh body = make_robot_body();
    Vec3 sum = Vec3::Zero();
    for (const Vec3& point : body.positions) {
        sum += point;
    }
    EXPECT_NEAR(sum.x() / static_cast<double>(body.positions.size()), 0.0, 1e-4);
}

}  // namespace
}  // namespace handhold::robot_body_test

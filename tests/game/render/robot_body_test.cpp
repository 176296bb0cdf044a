#include "game/render/robot_body.hpp"

#include <array>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "game/render/body_figures.hpp"
#include "systems/rigs/body_rig_fit.hpp"

namespace handhold::robot_body_test {
namespace {

TEST(RobotBody, IsAFigureWithAllBones) {
    const SkinnedMesh body = make_robot_body();
    const Result<BodyRig> rig = fit_body_rig(body);
    ASSERT_TRUE(rig.ok()) << rig.error().message();
    EXPECT_NEAR(rig.value().shoulder_width_m, 0.38, 1e-6);
    // Standing on its soles: eyes at the height it was built for, up to a sole's thickness.
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

TEST(RobotBody, HandJointsAreInHandSpace) {
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

TEST(RobotBody, BytesAreDeterministic) { EXPECT_EQ(make_robot_body_glb(), make_robot_body_glb()); }

// Every vertex has a mirrored one.
TEST(RobotBody, IsSymmetric) {
    const SkinnedMesh body = make_robot_body();
    const auto key = [](const Vec3& p) {
        const auto tenths = [](double m) { return std::lround(m * 1e4); };
        return std::array<long, 3>{tenths(p.x()), tenths(p.y()), tenths(p.z())};
    };
    std::set<std::array<long, 3>> cells;
    for (const Vec3& point : body.positions) {
        cells.insert(key(point));
    }
    const auto is_there = [&](const Vec3& point) {
        const auto [x, y, z] = key(point);
        for (long i = 0; i < 27; ++i) {
            if (cells.contains({x + i % 3 - 1, y + i / 3 % 3 - 1, z + i / 9 - 1})) {
                return true;
            }
        }
        return false;
    };
    std::size_t alone = 0;
    for (const Vec3& point : body.positions) {
        alone += is_there(Vec3(-point.x(), point.y(), point.z())) ? 0U : 1U;
    }
    EXPECT_EQ(alone, 0U) << "of " << body.positions.size();
}

}  // namespace
}  // namespace handhold::robot_body_test

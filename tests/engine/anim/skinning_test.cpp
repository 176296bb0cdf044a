#include "engine/anim/skinning.hpp"

#include <numbers>

#include <gtest/gtest.h>

#include "engine/core/check.hpp"

namespace handhold::skinning_test {
namespace {

struct Strip {
    std::vector<Vec3> positions = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(2, 0, 0)};
    std::vector<Vec3> normals = {Vec3::UnitY(), Vec3::UnitY(), Vec3::UnitY()};
    std::vector<SkinWeights> weights = {{{0, 0, 0, 0}, {1, 0, 0, 0}},
                                        {{0, 1, 0, 0}, {0.5F, 0.5F, 0, 0}},
                                        {{1, 0, 0, 0}, {1, 0, 0, 0}}};
    std::vector<Pose> bind = {{}, {Vec3(1, 0, 0), rotation_about(Vec3::UnitX(), 0.7)}};
    std::vector<Vec3> out_positions, out_normals;

    void run(const std::vector<Pose>& pose) {
        std::vector<Affine> carry;
        for (std::size_t i = 0; i < pose.size(); ++i) {
            carry.push_back(to_affine(pose[i] * inverse(bind[i])));
        }
        skin_vertices({positions, normals, weights, carry}, out_positions, out_normals);
    }
};

TEST(SkinVertices, BindPoseChangesNothing) {
    Strip strip;
    strip.run(strip.bind);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR((strip.out_positions[i] - strip.positions[i]).norm(), 0.0, 1e-15);
        EXPECT_NEAR((strip.out_normals[i] - Vec3::UnitY()).norm(), 0.0, 1e-15);
    }
}

TEST(SkinVertices, FollowCommonMotionOfAllJoints) {
    Strip strip;
    const Pose move{Vec3(3, -2, 1), rotation_about(Vec3(2, -1, 2) / 3.0, 0.9)};
    strip.run({move * strip.bind[0], move * strip.bind[1]});
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR((strip.out_positions[i] - transform_point(move, strip.positions[i])).norm(),
                    0.0, 1e-14);
        EXPECT_NEAR((strip.out_normals[i] - move.rotation * Vec3::UnitY()).norm(), 0.0, 1e-14);
    }
}

// The second joint turns a quarter about Z through (1, 0, 0): (2, 0, 0) moves to (1, 1, 0). A
// vertex weighted equally to both joints moves to the mean.
TEST(SkinVertices, BlendJointTransformsByWeight) {
    Strip strip;
    strip.weights[2] = {{0, 1, 0, 0}, {0.5F, 0.5F, 0, 0}};
    const Quat quarter = rotation_about(Vec3::UnitZ(), std::numbers::pi / 2.0);
    strip.run({strip.bind[0], {Vec3(1, 0, 0), quarter * strip.bind[1].rotation}});
    EXPECT_NEAR((strip.out_positions[0] - Vec3(0, 0, 0)).norm(), 0.0, 1e-14);
    EXPECT_NEAR((strip.out_positions[1] - Vec3(1, 0, 0)).norm(), 0.0, 1e-14);
    EXPECT_NEAR((strip.out_positions[2] - Vec3(1.5, 0.5, 0)).norm(), 0.0, 1e-14);
    EXPECT_NEAR((strip.out_normals[2] - Vec3(-1, 1, 0).normalized()).norm(), 0.0, 1e-14);
}

TEST(SkinVertices, RejectMissingJointPose) {
    Strip strip;
    EXPECT_THROW(strip.run({Pose()}), PreconditionError);
}

}  // namespace
}  // namespace handhold::skinning_test

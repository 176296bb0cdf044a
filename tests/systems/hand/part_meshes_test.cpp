#include "systems/hand/shared/part_meshes.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>

#include <gtest/gtest.h>

#include "systems/hand/shared/resized_meshes.hpp"
#include "tests/random.hpp"

namespace handhold::part_meshes_test {
namespace {

using test::Random;

PartCapsule capsule_of(double length_m, double radius_m) {
    PartCapsule capsule;
    capsule.end_bs = Vec3(0.0, -length_m, 0.0);
    capsule.radius_m = radius_m;
    return capsule;
}

// The size of a capsule that is measured again in each frame differs by rounding.
TEST(PartMeshes, RoundingDoesNotChangeTheMesh) {
    PartMeshes meshes;
    for (int step = 20; step < 60; ++step) {
        const double length_m = 0.005 * step;
        const auto capsule = [&](double noise) {
            return capsule_of(length_m * (1.0 + noise), 0.0605 * (1.0 + noise));
        };
        meshes.drop_if_many(1);
        meshes.add(capsule(0.0));
        const GripMesh* const found = meshes.find(capsule(0.0));
        ASSERT_NE(found, nullptr);
        for (const double noise : {-1e-15, -1e-16, 1e-16, 1e-15}) {
            EXPECT_EQ(meshes.find(capsule(noise)), found) << length_m << ' ' << noise;
        }
    }
}

// Hands and players of every size: a mouse's hand on a giant, and the reverse.
TEST(PartMeshes, MeshesAreAsLargeAsTheirParts) {
    Random random(7);
    for (int i = 0; i < 60; ++i) {
        const double length_m = std::pow(10.0, random.between(-2.5, 2.5));
        const double radius_m = length_m * random.between(0.05, 0.5);
        const PartCapsule capsule = capsule_of(length_m, radius_m);
        PartMeshes meshes;
        meshes.add(capsule);
        const GripMesh* const mesh = meshes.find(capsule);
        ASSERT_NE(mesh, nullptr);
        double far_m = 0.0;
        for (const Vec3& position : mesh->contact.positions) {
            far_m = std::max(far_m, position.norm());
        }
        const double expected_m = 0.5 * length_m + std::max(radius_m, k_min_part_m);
        EXPECT_NEAR(far_m, expected_m, 0.01 * expected_m) << length_m << ' ' << radius_m;
        EXPECT_LT(mesh->contact.triangles.size(), 20000U) << length_m << ' ' << radius_m;
    }
}

// An arm that is stretched from frame to frame.
TEST(PartMeshes, KeepABoundedNumber) {
    PartMeshes meshes;
    std::size_t most = 0;
    for (int frame = 0; frame < 400; ++frame) {
        meshes.drop_if_many(1);
        const PartCapsule capsule = capsule_of(0.01 * std::pow(1.01, frame), 0.01);
        meshes.add(capsule);
        ASSERT_NE(meshes.find(capsule), nullptr);
        most = std::max(most, meshes.size());
    }
    EXPECT_GT(most, k_many_part_meshes / 2);
    EXPECT_LE(most, k_many_part_meshes + 1);
}

TEST(ResizedMeshes, KeepNoMeshThatNobodyElseHas) {
    ResizedMeshes cache;
    Shape ball;
    ball.kind = ShapeKind::sphere;
    for (int round = 1; round <= 20; ++round) {
        ball.radius_m = 0.05 * round;
        const auto mesh = std::make_shared<const GripMesh>(build_grip_mesh(ball));
        for (const double scale : {0.5, 2.0}) {
            const GripMesh& resized = cache.get(mesh, scale);
            EXPECT_EQ(&cache.get(mesh, scale), &resized);
            EXPECT_NE(resized.digest, mesh->digest);
            EXPECT_NEAR(resized.contact.positions[0].norm(), ball.radius_m / scale,
                        1e-6 * ball.radius_m);
        }
        EXPECT_EQ(mesh.use_count(), 1);
        EXPECT_LE(cache.size(), 2U);
    }
}

}  // namespace
}  // namespace handhold::part_meshes_test

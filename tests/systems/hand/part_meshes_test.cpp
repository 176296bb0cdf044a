#include "systems/hand/shared/part_meshes.hpp"

#include <gtest/gtest.h>

namespace handhold::part_meshes_test {
namespace {

// The size of a capsule that is measured again in each frame differs by rounding.
TEST(PartMeshes, RoundingDoesNotChangeTheMesh) {
    PartMeshes meshes;
    for (int step = 20; step < 60; ++step) {
        const double length_m = 0.005 * step;
        const auto capsule = [&](double noise) {
            PartCapsule of_length;
            of_length.end_bs = Vec3(0.0, -length_m * (1.0 + noise), 0.0);
            of_length.radius_m = 0.0605 * (1.0 + noise);
            return of_length;
        };
        meshes.add(capsule(0.0));
        const GripMesh* const found = meshes.find(capsule(0.0));
        ASSERT_NE(found, nullptr);
        for (const double noise : {-1e-15, -1e-16, 1e-16, 1e-15}) {
            EXPECT_EQ(meshes.find(capsule(noise)), found) << length_m << ' ' << noise;
        }
    }
}

}  // namespace
}  // namespace handhold::part_meshes_test

#include <algorithm>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "engine/geometry/chain_fit.hpp"
#include "tests/engine/geometry/penetration_oracle.hpp"
#include "tests/engine/geometry/three_link_chain.hpp"

namespace handhold::find_penetration_test {
namespace {

using test::Random;

TEST(FindPenetration, IsDeepestOverAllTrianglesInAnyFrame) {
    Random random(1708);
    const GripMesh ball = build_grip_mesh(*test::make_wavy_ball(0.06, 16, 24));
    const GripMesh box = build_grip_mesh(*test::make_box_mesh({0.04, 0.02, 0.03}));
    int crossed = 0;
    for (int i = 0; i < 300; ++i) {
        const Pose frame = {random.vector(3.0), random.rotation()};
        const std::vector<PlacedMesh> meshes = {{&ball, frame * random.pose(0.05)},
                                                {&box, frame * random.pose(0.05)}};
        Capsule capsule;
        capsule.ends = {transform_point(frame, random.vector(0.1)),
                        transform_point(frame, random.vector(0.1))};
        capsule.radius_m = random.between(0.004, 0.012);
        const CapsulePenetration found = find_penetration(capsule, meshes);
        EXPECT_NEAR(found.depth_m, std::max(0.0, -test::gap_m(capsule, meshes)), 1e-8) << i;
        // Oracle: the first ray hit along the axis.
        std::optional<double> first;
        for (const PlacedMesh& placed : meshes) {
            const auto hit = placed.mesh->contact_bvh.cast_ray(
                inverse_transform_point(placed.pose, capsule.ends[0]),
                inverse_transform_point(placed.pose, capsule.ends[1]));
            if (hit) {
                const double at = hit->distance_m / (capsule.ends[1] - capsule.ends[0]).norm();
                first = std::min(first.value_or(1.0), at);
            }
        }
        ASSERT_EQ(found.crossed_at.has_value(), first.has_value()) << i;
        if (first) {
            ++crossed;
            EXPECT_NEAR(*found.crossed_at, *first, 1e-9) << i;
        }
    }
    EXPECT_GT(crossed, 50);
}

}  // namespace
}  // namespace handhold::find_penetration_test

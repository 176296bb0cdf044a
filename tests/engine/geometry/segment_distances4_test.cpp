#include "engine/geometry/segment_distances4.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "engine/geometry/segment_triangle.hpp"
#include "tests/random.hpp"

namespace handhold::segment_distances4_test {
namespace {

using test::Random;

// Triangles of all shapes: slivers, degenerate ones, large ones and near ones.
Corners random_triangle(Random& random) {
    const Vec3 middle = random.vector(0.05);
    const double size = std::pow(10.0, random.between(-4.0, 0.0));
    Corners corners;
    for (Vec3& corner : corners) {
        corner = middle + random.vector(size);
    }
    const double shape = random.between(0.0, 1.0);
    if (shape < 0.3) {
        const double off_m = shape < 0.1 ? 0.0 : std::pow(10.0, random.between(-9.0, -4.0));
        corners[2] = corners[0] + random.between(-0.5, 1.5) * (corners[1] - corners[0]);
        corners[2] += random.vector(off_m);
    } else if (shape < 0.32) {
        corners[1] = corners[0];
        corners[2] = corners[0];
    }
    return corners;
}

Corners4 side_by_side(const std::array<Corners, 4>& triangles) {
    Corners4 four;
    for (std::size_t c = 0; c < 3; ++c) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            for (std::size_t lane = 0; lane < 4; ++lane) {
                four[c][axis][lane] =
                    static_cast<float>(triangles[lane][c][static_cast<Eigen::Index>(axis)]);
            }
        }
    }
    return four;
}

// Oracle: nearest_between in doubles. A lower bound must never exceed the distance and should
// mostly be tight.
TEST(SegmentDistances4, NeverExceedTheTrueDistances) {
    Random random(1620);
    int compared = 0;
    int loose = 0;
    for (int i = 0; i < 50000; ++i) {
        std::array<Corners, 4> triangles;
        for (Corners& triangle : triangles) {
            triangle = random_triangle(random);
        }
        const double length_m = i % 50 == 0 ? 0.0 : random.between(0.001, 0.08);
        const Float4 length = splat4(length_m);
        const Corners4 corner = side_by_side(triangles);
        const Float4 squared = SegmentDistances4(corner, length).squared();
        for (std::size_t lane = 0; lane < 4; ++lane) {
            double largest_m = length_m;
            for (const Vec3& point : triangles[lane]) {
                largest_m = std::max(largest_m, point.cwiseAbs().maxCoeff());
            }
            const double rounding_m = 0x1p-20 * largest_m;
            const double expected_m =
                nearest_between({Vec3::Zero(), length_m * Vec3::UnitX()}, triangles[lane])
                    .distance_m;
            const double found_m = std::sqrt(static_cast<double>(squared[lane]));
            ASSERT_LE(found_m, expected_m + rounding_m) << i << ", " << lane;
            ++compared;
            loose += found_m < expected_m - 8.0 * rounding_m ? 1 : 0;
        }
    }
    EXPECT_LT(loose, compared / 100);  // slivers whose normals are inexact in floats
}

}  // namespace
}  // namespace handhold::segment_distances4_test

#include "engine/geometry/segment_triangle.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/engine/geometry/penetration_oracle.hpp"

namespace handhold::segment_triangle_test {
namespace {

using test::Random;

// Triangles of all shapes: some slivers, some as long as they are far, some cut by the segment.
Corners random_triangle(Random& random) {
    const Vec3 middle = random.vector(0.05);
    const double size = std::pow(10.0, random.between(-3.0, -1.0));
    Corners corners;
    for (Vec3& corner : corners) {
        corner = middle + random.vector(size);
    }
    if (random.between(0.0, 1.0) < 0.2) {
        corners[2] = 0.5 * (corners[0] + corners[1]) + random.vector(1e-6);
    }
    return corners;
}

TEST(NearestBetween, IsTheLeastOverTheSegmentsPoints) {
    Random random(1601);
    int passing = 0;
    for (int i = 0; i < 20000; ++i) {
        const Corners corners = random_triangle(random);
        const std::array<Vec3, 2> segment = {random.vector(0.06), random.vector(0.06)};
        const SegmentTriangle found = nearest_between(segment, corners);
        ASSERT_NEAR(found.distance_m, test::segment_to_triangle_m(segment, corners), 1e-8) << i;
        ASSERT_NEAR((found.on_segment - found.on_triangle).norm(), found.distance_m, 1e-12);
        ASSERT_LT((found.on_segment - closest_on_segment(found.on_segment, segment[0], segment[1]))
                      .norm(),
                  1e-12);
        ASSERT_LT((found.on_triangle - closest_on_triangle(found.on_triangle, corners)).norm(),
                  1e-9);
        passing += found.distance_m == 0.0 ? 1 : 0;
    }
    EXPECT_GT(passing, 100);
}

TEST(NearestBetween, IsSymmetricInTheSegmentsEndsAndInTheTrianglesWinding) {
    Random random(1602);
    for (int i = 0; i < 5000; ++i) {
        const Corners corners = random_triangle(random);
        const std::array<Vec3, 2> segment = {random.vector(0.06), random.vector(0.06)};
        const double distance_m = nearest_between(segment, corners).distance_m;
        ASSERT_NEAR(nearest_between({segment[1], segment[0]}, corners).distance_m, distance_m,
                    1e-12);
        ASSERT_NEAR(nearest_between(segment, {corners[0], corners[2], corners[1]}).distance_m,
                    distance_m, 1e-12);
    }
}

TEST(NearestBetween, TakesAPointForASegment) {
    Random random(1603);
    for (int i = 0; i < 2000; ++i) {
        const Corners corners = random_triangle(random);
        const Vec3 point = random.vector(0.06);
        ASSERT_NEAR(nearest_between({point, point}, corners).distance_m,
                    (point - closest_on_triangle(point, corners)).norm(), 1e-12);
    }
}

}  // namespace
}  // namespace handhold::segment_triangle_test

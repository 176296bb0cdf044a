#include "engine/geometry/distance_lower_bound.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "engine/geometry/closest_point.hpp"
#include "engine/geometry/triangle_bvh.hpp"
#include "triangle_soup.hpp"

namespace handhold::distance_lower_bound_test {
namespace {

using test::make_soup;
using test::Random;

TEST(DistanceLowerBound, NeverExceedsDistanceAndTightBoundIsTight) {
    Random random(806);
    const Mesh mesh = make_soup(random, 400);
    const TriangleBvh bvh(mesh.positions, mesh.triangles);
    OrientedBox everything;
    everything.half_extents = Vec3::Constant(10.0);
    constexpr double k_rounding = 1e-5;  // ten times the rounding error
    for (int i = 0; i < 200; ++i) {
        const Vec3 local = random.vector(std::pow(10.0, random.between(-2.0, 1.0)));
        const DistanceLowerBound lower_bound(local, bvh.reach_m());
        const double clearance_m = k_rounding * (bvh.reach_m() + local.norm());
        std::size_t seen = 0;
        bvh.visit_near_box(
            everything, [&](std::uint32_t first_slot, std::uint32_t count, const Triangles4& four) {
                const Float4 loose = lower_bound.squared(four);
                const Float4 tight = lower_bound.squared_tight(four);
                for (std::uint32_t lane = 0; lane < count; ++lane) {
                    const Corners corners = bvh.corners_at(first_slot + lane);
                    const Vec3 point = local + bvh.origin();
                    const double distance_m = (closest_on_triangle(point, corners) - point).norm();
                    const double loose_m = std::sqrt(static_cast<double>(loose[lane]));
                    const double tight_m = std::sqrt(static_cast<double>(tight[lane]));
                    ASSERT_LE(loose_m, distance_m * (1.0 + 1e-6)) << i;
                    ASSERT_LE(tight_m, distance_m * (1.0 + 1e-6)) << i;
                    ASSERT_GE(tight_m, distance_m - clearance_m) << i;
                }
                seen += count;
            });
        ASSERT_EQ(seen, mesh.triangles.size());
    }
}

// Random boxes, some flat, some containing the point.
TEST(DistanceLowerBound, NeverExceedsDistanceOfBox) {
    Random random(807);
    for (int i = 0; i < 5000; ++i) {
        const double scale = std::pow(10.0, random.between(-2.0, 2.0));
        const Vec3 point = random.vector(scale);
        Boxes4 boxes;
        std::array<double, 4> distance_m = {};
        double reach_m = 0.0;
        for (std::size_t lane = 0; lane < 4; ++lane) {
            const Vec3 a = random.vector(scale);
            Vec3 b = a + random.vector(random.between(0.0, 1.0) * scale);
            b.x() = lane == 0 ? a.x() : b.x();
            Vec3 low;
            Vec3 high;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const auto at = static_cast<Eigen::Index>(axis);
                boxes.low[axis][lane] = static_cast<float>(std::min(a[at], b[at]));
                boxes.high[axis][lane] = static_cast<float>(std::max(a[at], b[at]));
                low[at] = static_cast<double>(boxes.low[axis][lane]);
                high[at] = static_cast<double>(boxes.high[axis][lane]);
                reach_m = std::max({reach_m, -low[at], high[at]});
            }
            distance_m[lane] = (low - point).cwiseMax(point - high).cwiseMax(0.0).norm();
        }
        const DistanceLowerBound lower_bound(point, reach_m);
        const Float4 squared = lower_bound.squared(boxes);
        for (std::size_t lane = 0; lane < 4; ++lane) {
            const double bound_m = std::sqrt(static_cast<double>(squared[lane]));
            ASSERT_LE(bound_m, distance_m[lane] * (1.0 + 1e-6)) << i;
            ASSERT_GE(bound_m, distance_m[lane] - 1e-5 * (reach_m + point.norm())) << i;
        }
    }
}

}  // namespace
}  // namespace handhold::distance_lower_bound_test

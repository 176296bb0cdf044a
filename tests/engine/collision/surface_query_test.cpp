#include "engine/collision/surface_query.hpp"

#include <gtest/gtest.h>

namespace handhold::surface_query_test {
namespace {

// Answers with what it was asked.
struct Echo {
    std::uint64_t id = 0;
    std::optional<RayHit> cast_ray(const Vec3& from_ws, const Vec3& to_ws,
                                   std::span<const std::uint64_t> skip) const {
        return RayHit{id + skip.size(), from_ws, to_ws, 1.0};
    }
    std::optional<RayHit> cast_sphere(double radius_m, const Vec3& from_ws, const Vec3& to_ws,
                                      std::span<const std::uint64_t> skip) const {
        return RayHit{id + skip.size(), from_ws, to_ws, radius_m};
    }
    std::optional<SurfacePoint> closest_point(const Vec3& point_ws, double max_distance_m,
                                              std::span<const std::uint64_t> skip) const {
        return SurfacePoint{id + skip.size(), point_ws, Vec3::UnitX(), max_distance_m};
    }
    std::optional<SurfacePoint> closest_point_on(std::uint64_t wanted, const Vec3& point_ws) const {
        return SurfacePoint{wanted, point_ws, Vec3::UnitX(), 0.5};
    }
};

TEST(SurfaceQuery, WithoutAnObjectFindsNothing) {
    const SurfaceQuery query;
    EXPECT_FALSE(query);
    EXPECT_FALSE(query.cast_ray(Vec3::Zero(), Vec3::UnitX()));
    EXPECT_FALSE(query.cast_sphere(0.1, Vec3::Zero(), Vec3::UnitX()));
    EXPECT_FALSE(query.closest_point(Vec3::Zero(), 1.0));
    EXPECT_FALSE(query.closest_point_on(1, Vec3::Zero()));
}

TEST(SurfaceQuery, AsksItsObjectAndCopiesReferToTheSameOne) {
    Echo echo{7};
    SurfaceQuery query(echo);
    const SurfaceQuery copy = query;  // NOLINT(performance-unnecessary-copy-initialization)
    echo.id = 40;
    const std::uint64_t skip[2] = {1, 2};
    const Vec3 a(1.0, 2.0, 3.0);
    const Vec3 b(4.0, 5.0, 6.0);
    EXPECT_TRUE(copy);
    EXPECT_EQ(copy.cast_ray(a, b, skip)->id, 42U);
    EXPECT_EQ(copy.cast_ray(a, b)->normal_ws, b);
    EXPECT_EQ(copy.cast_sphere(0.25, a, b, skip)->distance_m, 0.25);
    EXPECT_EQ(copy.closest_point(a, 3.0, skip)->distance_m, 3.0);
    EXPECT_EQ(copy.closest_point_on(9, b)->id, 9U);
    EXPECT_EQ(copy.closest_point_on(9, b)->point_ws, b);
}

}  // namespace
}  // namespace handhold::surface_query_test

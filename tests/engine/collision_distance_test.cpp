#include <gtest/gtest.h>

#include "collision_scene.hpp"
#include "engine/collision/convex_core.hpp"

// The oracle of most tests here is a certificate: two points, one on each convex body, are the
// closest pair if and only if no point of either body lies between the planes through them across
// the line between them.
namespace handhold {
namespace {

using test::Random;

Vec3 inside_triangle(Random& random, const Corners& c) {
    double u = random.between(0.0, 1.0);
    double v = random.between(0.0, 1.0);
    if (u + v > 1.0) {
        u = 1.0 - u;
        v = 1.0 - v;
    }
    return c[0] + u * (c[1] - c[0]) + v * (c[2] - c[0]);
}

TEST(ClosestPoint, OnTriangleNoOtherPointIsNearer) {
    Random random(1);
    for (int round = 0; round < 2000; ++round) {
        const Corners corners{random.vector(1.0), random.vector(1.0), random.vector(1.0)};
        const Vec3 point = random.vector(2.0);
        const Vec3 closest = closest_on_triangle(point, corners);
        const Vec3 way = point - closest;
        for (const Vec3& corner : corners) {
            ASSERT_LE((corner - closest).dot(way), 1e-12);
        }
        // On the triangle: its own closest point.
        ASSERT_LT((closest_on_triangle(closest, corners) - closest).norm(), 1e-12);
    }
}

TEST(ClosestPoint, OnSliversAndPointsIsStillOnThem) {
    Random random(2);
    for (int round = 0; round < 2000; ++round) {
        const Vec3 a = random.vector(1.0);
        const Vec3 b = random.vector(1.0);
        const double thickness = std::pow(10.0, random.between(-18.0, -6.0));
        const Corners corners{
            a, b, a + random.between(0.0, 1.0) * (b - a) + thickness * random.direction()};
        const Vec3 point = random.vector(2.0);
        const Vec3 expected = closest_on_segment(point, a, b);
        ASSERT_NEAR((closest_on_triangle(point, corners) - point).norm(), (expected - point).norm(),
                    2.0 * thickness + 1e-12);
    }
    EXPECT_EQ(closest_on_triangle(Vec3::UnitX(), {Vec3::Zero(), Vec3::Zero(), Vec3::Zero()}),
              Vec3::Zero());
}

TEST(ClosestPoint, BetweenSegmentsIsNoFartherThanAnySample) {
    Random random(3);
    for (int round = 0; round < 300; ++round) {
        const std::array<Vec3, 2> a{random.vector(1.0), random.vector(1.0)};
        std::array<Vec3, 2> b{random.vector(1.0), random.vector(1.0)};
        if (round % 3 == 0) {
            b[1] = b[0] + random.between(-2.0, 2.0) * (a[1] - a[0]);  // parallel
        }
        const auto [on_a, on_b] = closest_between_segments(a, b);
        const double distance = (on_a - on_b).norm();
        for (int i = 0; i <= 50; ++i) {
            const Vec3 point = a[0] + i / 50.0 * (a[1] - a[0]);
            ASSERT_GE((closest_on_segment(point, b[0], b[1]) - point).norm(), distance - 1e-9);
        }
        ASSERT_LT((closest_on_segment(on_a, a[0], a[1]) - on_a).norm(), 1e-12);
        ASSERT_LT((closest_on_segment(on_b, b[0], b[1]) - on_b).norm(), 1e-12);
    }
}

ConvexCore random_core(Random& random, int kind, double spread) {
    Shape shape;
    const Pose pose = test::at(random.vector(spread), random.rotation());
    if (kind == 0) {
        shape.kind = ShapeKind::sphere;
        shape.radius_m = 0.1;
        return make_core(shape, pose);
    }
    if (kind == 1) {
        shape.kind = ShapeKind::capsule;
        shape.radius_m = 0.1;
        shape.half_height_m = random.between(0.05, 0.5);
        return make_core(shape, pose);
    }
    if (kind == 2) {
        shape.kind = ShapeKind::box;
        shape.half_m = {random.between(0.02, 0.5), random.between(0.02, 0.5),
                        random.between(0.02, 0.5)};
        return make_core(shape, pose);
    }
    const Corners corners{pose.position + random.vector(0.5), pose.position + random.vector(0.5),
                          pose.position + random.vector(0.5)};
    return make_triangle_core(corners, area_vector(corners).normalized());
}

double gap_along(const ConvexCore& a, const ConvexCore& b, const Vec3& direction) {
    return direction.dot(support_vertex(a, -direction) - support_vertex(b, direction));
}

TEST(SeparateCores, DisjointPairsCarryTheirCertificate) {
    Random random(4);
    int disjoint = 0;
    for (int round = 0; round < 4000; ++round) {
        const ConvexCore a = random_core(random, round % 3, 1.0);
        const ConvexCore b = random_core(random, round / 3 % 4, 1.0);
        const CoreSeparation s = *separate_cores(a, b);
        if (s.overlap) {
            continue;
        }
        ++disjoint;
        ASSERT_NEAR(s.normal.norm(), 1.0, 1e-12);
        ASSERT_NEAR((s.point_a_ns - s.point_b_ns - s.separation_m * s.normal).norm(), 0.0, 1e-12);
        ASSERT_NEAR(gap_along(a, b, s.normal), s.separation_m, 1e-9);
    }
    EXPECT_GT(disjoint, 2000);
}

TEST(SeparateCores, OverlapIsTheLeastWayOut) {
    Random random(5);
    int overlapping = 0;
    for (int round = 0; round < 3000; ++round) {
        const ConvexCore a = random_core(random, round % 2 == 0 ? 2 : round % 3, 0.3);
        const ConvexCore b = random_core(random, a.kind == CoreKind::box ? round / 2 % 4 : 2, 0.3);
        const CoreSeparation s = *separate_cores(a, b);
        if (!s.overlap) {
            continue;
        }
        ++overlapping;
        ASSERT_NEAR(gap_along(a, b, s.normal), s.separation_m,
                    1e-9);  // moved out by it they just touch
        for (int i = 0; i < 100; ++i) {
            ASSERT_LE(gap_along(a, b, random.direction()), s.separation_m + 2e-7);
        }
    }
    EXPECT_GT(overlapping, 500);
}

TEST(SeparateCores, MirroredPairsAgree) {
    Random random(6);
    for (int round = 0; round < 1000; ++round) {
        const ConvexCore a = random_core(random, round % 3, 0.5);
        const ConvexCore b = random_core(random, round / 3 % 3, 0.5);
        ASSERT_NEAR(separate_cores(a, b)->separation_m, separate_cores(b, a)->separation_m, 1e-9);
    }
}

TEST(SeparateCores, LimitOnlyLeavesOutWhatIsFarther) {
    Random random(7);
    for (int round = 0; round < 1000; ++round) {
        const ConvexCore a = random_core(random, round % 3, 1.0);
        const ConvexCore b = random_core(random, 3, 1.0);
        if (!separate_cores(a, b, 0.2)) {
            ASSERT_GT(separate_cores(a, b)->separation_m, 0.2);
        }
    }
}

TEST(SeparateCores, CapsuleThroughTriangleOverlaps) {
    Shape capsule;
    capsule.kind = ShapeKind::capsule;
    capsule.radius_m = 0.01;
    capsule.half_height_m = 0.3;
    const ConvexCore a = make_core(capsule, test::at({0.1, 0.2, 0.1}));
    const Corners corners{Vec3(-1.0, 0.0, -1.0), Vec3(-1.0, 0.0, 3.0), Vec3(3.0, 0.0, -1.0)};
    const CoreSeparation s = *separate_cores(a, make_triangle_core(corners, Vec3::UnitY()));
    EXPECT_TRUE(s.overlap);
    EXPECT_NEAR(s.separation_m, -0.1, 1e-12);  // its lower end is at -0.1
    EXPECT_NEAR(s.normal.y(), 1.0, 1e-12);
}

TEST(SeparateCores, CoincidentCoresAlwaysTakeTheSameWayOut) {
    Shape sphere;
    sphere.radius_m = 0.1;
    const CoreSeparation s = *separate_cores(make_core(sphere, {}), make_core(sphere, {}));
    EXPECT_EQ(s.separation_m, 0.0);
    EXPECT_EQ(s.normal, Vec3::UnitY());
}

TEST(ClosestPoint, InsidePointsOfATriangleAreTheirOwn) {
    Random random(8);
    for (int round = 0; round < 500; ++round) {
        const Corners corners{random.vector(1.0), random.vector(1.0), random.vector(1.0)};
        const Vec3 point = inside_triangle(random, corners);
        ASSERT_LT((closest_on_triangle(point, corners) - point).norm(), 1e-12);
    }
}

}  // namespace
}  // namespace handhold

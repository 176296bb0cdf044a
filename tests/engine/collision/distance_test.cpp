#include <gtest/gtest.h>

#include "tests/engine/collision/oracle.hpp"

// Oracle of most tests here, an optimality certificate: two points, one on each convex body, are
// the closest pair if and only if no point of either body lies between the planes through them,
// perpendicular to their connection.
namespace handhold::collision_distance_test {
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

TEST(ClosestPoint, NoPointOfTheTriangleIsNearer) {
    Random random(1);
    for (int round = 0; round < 2000; ++round) {
        const Corners corners{random.vector(1.0), random.vector(1.0), random.vector(1.0)};
        const Vec3 point = random.vector(2.0);
        const Vec3 closest = closest_on_triangle(point, corners);
        const Vec3 offset = point - closest;
        for (const Vec3& corner : corners) {
            ASSERT_LE((corner - closest).dot(offset), 1e-12);
        }
        // A point of the triangle is its own closest point.
        ASSERT_LT((closest_on_triangle(closest, corners) - closest).norm(), 1e-12);
    }
}

TEST(ClosestPoint, DegenerateTrianglesHaveTheirClosestPoint) {
    Random random(2);
    for (int round = 0; round < 2000; ++round) {
        const Vec3 a = random.vector(1.0);
        const Vec3 b = random.vector(1.0);
        const double thickness = std::pow(10.0, random.between(-18.0, -6.0));
        const Vec3 c = a + random.between(0.0, 1.0) * (b - a);
        const Corners corners{a, b, c + thickness * random.direction()};
        const Vec3 point = random.vector(2.0);
        const Vec3 expected = closest_on_segment(point, a, b);
        ASSERT_NEAR((closest_on_triangle(point, corners) - point).norm(), (expected - point).norm(),
                    2.0 * thickness + 1e-12);
    }
    EXPECT_EQ(closest_on_triangle(Vec3::UnitX(), {Vec3::Zero(), Vec3::Zero(), Vec3::Zero()}),
              Vec3::Zero());
}

TEST(ClosestPoint, NoSampleOfTwoSegmentsIsNearer) {
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

ShapeId random_shape(Random& random, ShapeLibrary& shapes, int kind) {
    if (kind == 0) {
        return shapes.add_sphere(0.1);
    }
    if (kind == 1) {
        return shapes.add_capsule(0.1, random.between(0.05, 0.5));
    }
    if (kind == 2) {
        return shapes.add_box(
            {random.between(0.02, 0.5), random.between(0.02, 0.5), random.between(0.02, 0.5)});
    }
    auto mesh = std::make_shared<Mesh>();
    mesh->positions = {random.vector(0.5), random.vector(0.5), random.vector(0.5)};
    mesh->triangles = {{0, 1, 2}};
    return shapes.add_mesh(mesh);
}

// Two shapes, the second fixed at the origin, and their deepest contact in b's frame.
struct Meeting {
    test::Core a;
    test::Core b;
    ContactPoint contact;
};

Meeting meet(Random& random, int kind_a, int kind_b, double spread) {
    ShapeLibrary shapes;
    const ShapeId a = random_shape(random, shapes, kind_a);
    const ShapeId b = random_shape(random, shapes, kind_b);
    const Pose pose = random.pose(spread);
    const auto contacts = test::contacts_of(
        shapes, {test::resting(1, b, {}, false), test::resting(2, a, pose, true)}, {10.0, 0.005});
    Meeting meeting{test::make_core(shapes.at(a), pose), {}, {}};
    if (kind_b == 3) {
        const auto& corners = shapes.at(b).mesh->positions;
        meeting.b = test::make_triangle_core({corners[0], corners[1], corners[2]});
    } else {
        meeting.b = test::make_core(shapes.at(b), {});
    }
    meeting.contact.separation_m = 1e9;
    for (const ContactPoint& contact : contacts) {
        if (contact.separation_m < meeting.contact.separation_m) {
            meeting.contact = contact;
        }
    }
    return meeting;
}

TEST(Separation, DisjointPairsAreCertified) {
    Random random(4);
    int disjoint = 0;
    for (int round = 0; round < 4000; ++round) {
        const Meeting m = meet(random, round % 3, round / 3 % 4, 1.0);
        const ContactPoint& c = m.contact;
        ASSERT_LT(c.separation_m, 5.0);
        if (c.separation_m <= 1e-6) {
            continue;
        }
        ++disjoint;
        ASSERT_NEAR(c.normal_b_bs.norm(), 1.0, 1e-12);
        const Vec3 point_a = transform_point(m.a.pose, c.point_a_bs);
        ASSERT_NEAR((point_a - c.point_b_bs).dot(c.normal_b_bs), c.separation_m, 1e-9);
        ASSERT_NEAR(gap_along(m.a, m.b, c.normal_b_bs), c.separation_m, 1e-9);
    }
    EXPECT_GT(disjoint, 2000);
}

TEST(Separation, OverlappingPairsHaveTheShortestExit) {
    Random random(5);
    int overlapping = 0;
    for (int round = 0; round < 3000; ++round) {
        const int kind_a = round % 2 == 0 ? 2 : round % 3;
        const Meeting m = meet(random, kind_a, kind_a == 2 ? round / 2 % 3 : 2, 0.3);
        const ContactPoint& c = m.contact;
        if (c.separation_m > -1e-6) {
            continue;
        }
        ++overlapping;
        ASSERT_NEAR(gap_along(m.a, m.b, c.normal_b_bs), c.separation_m,
                    1e-9);  // moved by the depth, they just touch
        for (int i = 0; i < 100; ++i) {
            ASSERT_LE(gap_along(m.a, m.b, random.direction()), c.separation_m + 2e-7);
        }
    }
    EXPECT_GT(overlapping, 500);
}

TEST(Separation, CapsuleThroughATriangleIsMeasuredAtItsLowerEnd) {
    ShapeLibrary shapes;
    auto mesh = std::make_shared<Mesh>();
    mesh->positions = {{-1.0, 0.0, -1.0}, {-1.0, 0.0, 3.0}, {3.0, 0.0, -1.0}};
    mesh->triangles = {{0, 1, 2}};
    const ShapeId triangle = shapes.add_mesh(mesh);
    const ShapeId capsule = shapes.add_capsule(0.01, 0.3);
    const auto contacts =
        test::contacts_of(shapes, {test::resting(1, triangle, {}, false),
                                   test::resting(2, capsule, test::at({0.1, 0.2, 0.1}), true)});
    EXPECT_NEAR(test::deepest(contacts), -0.11, 1e-12);  // the lower end is at -0.1
    EXPECT_NEAR(contacts[0].normal_b_bs.y(), 1.0, 1e-12);
}

TEST(Separation, CoincidentSpheresHaveADeterministicExit) {
    ShapeLibrary shapes;
    const ShapeId sphere = shapes.add_sphere(0.1);
    const auto contacts = test::contacts_of(
        shapes, {test::resting(1, sphere, {}, false), test::resting(2, sphere, {}, true)});
    ASSERT_EQ(contacts.size(), 1U);
    EXPECT_NEAR(contacts[0].separation_m, -0.2, 1e-12);
    EXPECT_EQ(contacts[0].normal_b_bs, Vec3::UnitY());
}

TEST(ClosestPoint, PointsInATriangleAreTheirOwnClosestPoint) {
    Random random(8);
    for (int round = 0; round < 500; ++round) {
        const Corners corners{random.vector(1.0), random.vector(1.0), random.vector(1.0)};
        const Vec3 point = inside_triangle(random, corners);
        ASSERT_LT((closest_on_triangle(point, corners) - point).norm(), 1e-12);
    }
}

}  // namespace
}  // namespace handhold::collision_distance_test

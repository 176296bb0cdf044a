#include "engine/geometry/grip_mesh.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "engine/collision/shape_query.hpp"
#include "graph_claims.hpp"
#include "tests/engine/collision/scene.hpp"

// Oracle for tessellated shapes: the closed forms of shape_query.hpp.
namespace handhold::grip_mesh_test {
namespace {

using test::Random;

// Largest distance of the triangles from the true surface, sampled on a grid on each triangle.
double worst_deviation_m(const Shape& shape, const SurfaceGraph& graph) {
    double worst = 0.0;
    constexpr int k_grid = 8;
    for (const auto& [a, b, c] : graph.triangles) {
        for (int i = 0; i <= k_grid; ++i) {
            for (int j = 0; i + j <= k_grid; ++j) {
                const double u = static_cast<double>(i) / k_grid;
                const double v = static_cast<double>(j) / k_grid;
                const Vec3 point = (1.0 - u - v) * graph.positions[a] + u * graph.positions[b] +
                                   v * graph.positions[c];
                const Vec3 surface = closest_on_shape(shape, point).point;
                worst = std::max(worst, (surface - point).norm());
            }
        }
    }
    return worst;
}

void expect_closed_and_outward(const SurfaceGraph& graph) {
    EXPECT_EQ(graph.report.border_edges, 0U);
    EXPECT_EQ(graph.report.non_manifold_edges, 0U);
    EXPECT_EQ(graph.report.flipped_links, 0U);
    EXPECT_EQ(graph.report.kept, graph.report.triangles);
    for (std::size_t t = 0; t < graph.triangles.size(); ++t) {  // convex about the origin
        ASSERT_GT(graph.normals[t].dot(graph.positions[graph.triangles[t][0]]), 0.0);
    }
}

constexpr double k_tolerance_m = GripMeshSettings{}.shape_tolerance_m;

TEST(GripMesh, ConvexShapesDeviateAtMostByTheTolerance) {
    Random random(820);
    for (int round = 0; round < 12; ++round) {
        ShapeLibrary shapes;
        std::vector<Vec3> points(20);
        for (Vec3& point : points) {
            point = random.vector(0.2);
        }
        const double radius = std::pow(10.0, random.between(-2.5, -0.3));
        const double half = std::pow(10.0, random.between(-2.0, 0.3));
        shapes.add_box({radius, half, random.between(0.01, 0.3)});
        shapes.add_sphere(radius);
        shapes.add_capsule(radius, half);
        shapes.add_cylinder(radius, half);
        const ConvexHull hull = *make_convex_hull(points);
        Vec3 middle = Vec3::Zero();
        for (const Vec3& corner : hull.corners) {
            middle += corner / static_cast<double>(hull.corners.size());
        }
        shapes.add_hull(moved_hull(hull, test::at(-middle)));
        for (std::uint32_t i = 0; i < shapes.size(); ++i) {
            SCOPED_TRACE(static_cast<int>(shapes.at({i}).kind));
            const GripMesh grip = build_grip_mesh(shapes.at({i}));
            expect_closed_and_outward(grip.contact);
            EXPECT_LE(worst_deviation_m(shapes.at({i}), grip.contact), k_tolerance_m);
            // The other direction: no point of the shape is far from the triangles.
            for (int k = 0; k < 200; ++k) {
                const Vec3 out = 10.0 * random.direction();
                const Vec3 on_shape = closest_on_shape(shapes.at({i}), out).point;
                const auto near = grip.contact_bvh.closest_point(on_shape, 1.0);
                ASSERT_TRUE(near.has_value());
                ASSERT_LE(near->distance_m, 1.0001 * k_tolerance_m);
            }
        }
    }
}

TEST(GripMesh, HugeRoundShapesKeepDeviationAndSizeBounds) {
    ShapeLibrary shapes;
    shapes.add_sphere(30.0);
    shapes.add_cylinder(30.0, 2.0);
    for (std::uint32_t i = 0; i < shapes.size(); ++i) {
        const GripMesh grip = build_grip_mesh(shapes.at({i}));
        EXPECT_LE(grip.contact.triangles.size(), 70000U);
        EXPECT_LE(worst_deviation_m(shapes.at({i}), grip.contact), (i == 0 ? 1.6e-4 : 8e-5) * 30.0);
    }
}

TEST(GripMesh, CompoundMatchesDistanceToItsParts) {
    Random random(821);
    ShapeLibrary shapes;
    const ShapeId box = shapes.add_box({0.05, 0.1, 0.02});
    const ShapeId ball = shapes.add_sphere(0.06);
    const std::vector<CompoundChild> parts = {
        {box, test::at({0.0, 0.1, 0.0}, random.rotation()), 1.0},
        {ball, test::at({0.02, -0.05, 0.01}), 1.0}};
    const Shape& compound = shapes.at(shapes.add_compound(parts));
    const GripMesh grip = build_grip_mesh(compound);
    EXPECT_EQ(grip.contact.report.border_edges, 0U);
    EXPECT_EQ(grip.contact.report.parts, 2U);
    for (int i = 0; i < 300; ++i) {
        const Vec3 point = random.vector(0.4);
        const LocalSurfacePoint oracle = closest_on_shape(compound, point);
        if (oracle.distance_m > 1e-3) {
            const auto near = grip.contact_bvh.closest_point(point, 10.0);
            ASSERT_TRUE(near.has_value());
            ASSERT_NEAR(near->distance_m, oracle.distance_m, 1.001 * k_tolerance_m);
        }
    }
}

// The nearest points and first hits of a resized mesh are those of the original, resized.
TEST(GripMesh, ResizedMeshAnswersQueriesLikeTheOriginal) {
    ShapeLibrary library;
    const ShapeId id = library.add_cylinder(0.3, 0.5);
    const GripMesh original = build_grip_mesh(library.at(id));
    Random random(7);
    int hits = 0;
    for (const double factor : {0.05, 1.0, 3.0, 10.0}) {
        const GripMesh other = resized(original, factor);
        ASSERT_EQ(other.contact.triangles.size(), original.contact.triangles.size());
        for (int i = 0; i < 200; ++i) {
            const Vec3 from = random.vector(1.0);
            const Vec3 to = random.vector(1.0);
            const auto near = original.contact_bvh.closest_point(from, 2.0);
            const auto near_other = other.contact_bvh.closest_point(factor * from, factor * 2.0);
            ASSERT_TRUE(near && near_other);
            EXPECT_NEAR(near_other->distance_m, factor * near->distance_m, 1e-12 * factor);
            const auto hit = original.search_bvh.cast_ray(from, to);
            const auto hit_other = other.search_bvh.cast_ray(factor * from, factor * to);
            ASSERT_EQ(hit.has_value(), hit_other.has_value());
            if (hit) {
                ++hits;
                EXPECT_NEAR(hit_other->distance_m, factor * hit->distance_m, 1e-12 * factor);
            }
        }
    }
    EXPECT_GT(hits, 100);
}

TEST(GripMesh, ScaledMeshEqualsMeshOfScaledPositions) {
    ShapeLibrary shapes;
    const auto ball = test::make_wavy_ball(0.5, 12, 20);
    const Vec3 scale(0.5, 1.0, 3.0);
    const GripMesh grip = build_grip_mesh(shapes.at(shapes.add_mesh(ball, scale)));
    Mesh stretched = *ball;
    for (Vec3& position : stretched.positions) {
        position = position.cwiseProduct(scale);
    }
    const SurfaceGraph oracle = build_surface_graph(stretched);
    EXPECT_EQ(grip.contact.positions, oracle.positions);
    EXPECT_EQ(grip.contact.triangles, oracle.triangles);
    test::expect_valid_graph(grip.contact, stretched);
}

}  // namespace
}  // namespace handhold::grip_mesh_test

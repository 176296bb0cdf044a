#include "engine/geometry/round_grip_mesh.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "engine/geometry/shape_surface.hpp"
#include "tests/random.hpp"

namespace handhold::round_grip_mesh_test {
namespace {

using test::Random;

Shape random_shape(Random& random) {
    Shape shape;
    shape.radius_m = std::pow(10.0, random.between(-3.0, -1.0));
    if (random.between(0.0, 1.0) < 0.5) {
        shape.kind = ShapeKind::capsule;
        shape.half_height_m = std::pow(10.0, random.between(-3.0, 0.5));
    }
    return shape;
}

// Distance from the true surface of a sphere or capsule.
double deviation_m(const Shape& shape, const Vec3& point) {
    Vec3 axis = Vec3::Zero();
    axis.y() = std::clamp(point.y(), -shape.half_height_m, shape.half_height_m);
    return std::abs((point - axis).norm() - shape.radius_m);
}

// Oracle: build_surface_graph.
RC_GTEST_PROP(RoundGripMesh, ContactDetailIsTheSurfaceAsAnyMeshWouldBeLinked,
              (std::uint64_t seed)) {
    Random random(seed);
    const Shape shape = random_shape(random);
    const GripMeshSettings settings;
    const GripMesh grip = build_round_grip_mesh(shape, settings);
    WeldLimits closed = settings.weld;
    closed.seam_m = closed.seam_per_size = 0.0;
    const SurfaceGraph oracle =
        build_surface_graph(shape_surface(shape, settings.shape_tolerance_m), closed);
    RC_ASSERT(grip.contact.positions == oracle.positions);
    RC_ASSERT(grip.contact.triangles == oracle.triangles);
    RC_ASSERT(grip.contact.neighbours == oracle.neighbours);
    RC_ASSERT(grip.contact.normals == oracle.normals);
    RC_ASSERT(grip.contact.source_triangle == oracle.source_triangle);
    RC_ASSERT(grip.contact.report.parts == oracle.report.parts);
    RC_ASSERT(grip.contact.report.border_edges == oracle.report.border_edges);
    RC_ASSERT(grip.turned == 0U);
}

RC_GTEST_PROP(RoundGripMesh, SearchDetailDeviatesAsFarAsAllowed, (std::uint64_t seed)) {
    Random random(seed);
    const Shape shape = random_shape(random);
    const GripMeshSettings settings;
    const GripMesh grip = build_round_grip_mesh(shape, settings);
    RC_ASSERT(grip.search.triangles.size() >= 8U);
    RC_ASSERT(grip.search.triangles.size() <= grip.contact.triangles.size());
    RC_ASSERT(grip.search.report.border_edges == 0U);
    for (std::size_t t = 0; t < grip.search.triangles.size(); ++t) {
        const Corners c = corners_of(grip.search, t);
        RC_ASSERT(deviation_m(shape, (c[0] + c[1] + c[2]) / 3.0) < settings.search.deviation_m);
        RC_ASSERT(grip.search.source_triangle[t] < grip.full_triangles);
        RC_ASSERT(grip.search.normals[t].dot(c[0]) > 0.0);
    }
}

Vec3 random_point_on(const Shape& shape, Random& random) {
    const Vec3 on_axis(0.0, random.between(-shape.half_height_m, shape.half_height_m), 0.0);
    return on_axis + shape.radius_m * random.direction();
}

// Sums over all shapes of one kind.
struct Counts {
    int nears = 0;
    int hits = 0;
};

// Oracle: a tree built by the general TriangleBvh constructor.
void compare_trees(Counts& spheres, Counts& capsules) {
    Random random(*rc::gen::arbitrary<std::uint64_t>());
    const Shape shape = random_shape(random);
    Counts& counts = shape.kind == ShapeKind::capsule ? capsules : spheres;
    const GripMesh grip = build_round_grip_mesh(shape, {});
    const TriangleBvh oracle(grip.contact.positions, grip.contact.triangles);
    RC_ASSERT(grip.contact_bvh.triangle_count() == oracle.triangle_count());
    const double size_m = 2.0 * (shape.radius_m + shape.half_height_m);
    for (int i = 0; i < 50; ++i) {
        const Vec3 from = random.vector(size_m);
        const Vec3 on_shape = random_point_on(shape, random);
        const Vec3 to = on_shape + random.vector(shape.radius_m);
        const auto near = grip.contact_bvh.closest_point(from, size_m);
        const auto oracle_near = oracle.closest_point(from, size_m);
        RC_ASSERT(near.has_value() == oracle_near.has_value());
        RC_ASSERT(!near || near->triangle == oracle_near->triangle);
        const auto hit = grip.contact_bvh.cast_ray(from, to);
        const auto oracle_hit = oracle.cast_ray(from, to);
        RC_ASSERT(hit.has_value() == oracle_hit.has_value());
        RC_ASSERT(!hit || hit->triangle == oracle_hit->triangle);
        counts.nears += near ? 1 : 0;
        counts.hits += hit ? 1 : 0;
    }
}

TEST(RoundGripMesh, TreesFindWhatOthersFind) {
    Counts spheres;
    Counts capsules;
    EXPECT_TRUE(rc::check([&] { compare_trees(spheres, capsules); }));
    for (const Counts& counts : {spheres, capsules}) {
        EXPECT_GT(counts.nears, 200);
        EXPECT_GT(counts.hits, 200);
    }
}

}  // namespace
}  // namespace handhold::round_grip_mesh_test

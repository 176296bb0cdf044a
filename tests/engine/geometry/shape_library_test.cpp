#include "engine/geometry/shape_library.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "engine/core/check.hpp"

namespace handhold::collision_shape_library_test {
namespace {

TEST(ShapeLibrary, IdsAreGivenInOrderFromZero) {
    ShapeLibrary shapes;
    EXPECT_EQ(shapes.add_sphere(0.1).index, 0U);
    EXPECT_EQ(shapes.add_box({0.1, 0.2, 0.3}).index, 1U);
    EXPECT_EQ(shapes.size(), 2U);
    EXPECT_EQ(shapes.at({1}).half_m, Vec3(0.1, 0.2, 0.3));
    EXPECT_THROW(shapes.at({2}), PreconditionError);
}

TEST(ShapeLibrary, RefusesSizesOutsideOfTheirRange) {
    ShapeLibrary shapes;
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const double bad : {0.0, -1.0, 0.9e-3, 1.1e4, nan}) {
        EXPECT_THROW(shapes.add_sphere(bad), PreconditionError) << bad;
        EXPECT_THROW(shapes.add_box({1.0, bad, 1.0}), PreconditionError) << bad;
        EXPECT_THROW(shapes.add_capsule(bad, 1.0), PreconditionError) << bad;
        EXPECT_THROW(shapes.add_capsule(1.0, bad), PreconditionError) << bad;
    }
    EXPECT_EQ(shapes.size(), 0U);
}

TEST(ShapeLibrary, RefusesBrokenMeshes) {
    ShapeLibrary shapes;
    EXPECT_THROW(shapes.add_mesh(nullptr), PreconditionError);
    auto mesh = std::make_shared<Mesh>();
    mesh->positions = {Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY()};
    EXPECT_THROW(shapes.add_mesh(mesh), PreconditionError);
    mesh->triangles = {{0, 1, 3}};
    EXPECT_THROW(shapes.add_mesh(mesh), PreconditionError);
    mesh->triangles = {{0, 1, 2}};
    EXPECT_NO_THROW(shapes.add_mesh(mesh));
    mesh->positions[1].x() = std::numeric_limits<double>::infinity();
    EXPECT_THROW(shapes.add_mesh(mesh), PreconditionError);
}

TEST(ShapeLibrary, MeshesHaveExtentButNoInside) {
    ShapeLibrary shapes;
    auto mesh = std::make_shared<Mesh>();
    mesh->positions = {Vec3(3.0, 4.0, 0.0), Vec3::UnitX(), Vec3::UnitY()};
    mesh->triangles = {{0, 1, 2}};
    const Shape& shape = shapes.at(shapes.add_mesh(mesh));
    EXPECT_DOUBLE_EQ(bounding_radius(shape), 5.0);
    EXPECT_EQ(thinnest_half_extent(shape), 0.0);
    EXPECT_THROW(solid_inertia(shape, 1.0), PreconditionError);
}

TEST(ShapeLibrary, BoundingRadiusReachesTheFarthestPoint) {
    ShapeLibrary shapes;
    EXPECT_DOUBLE_EQ(bounding_radius(shapes.at(shapes.add_box({2.0, 3.0, 6.0}))), 7.0);
    EXPECT_DOUBLE_EQ(bounding_radius(shapes.at(shapes.add_sphere(0.5))), 0.5);
    EXPECT_DOUBLE_EQ(bounding_radius(shapes.at(shapes.add_capsule(0.5, 2.0))), 2.5);
    EXPECT_DOUBLE_EQ(thinnest_half_extent(shapes.at({0})), 2.0);
    EXPECT_DOUBLE_EQ(thinnest_half_extent(shapes.at({2})), 0.5);
}

// Oracle: the body sliced into discs across y, each disc's moments in closed form, integrated with
// Simpson's rule.
TEST(ShapeLibrary, CapsuleInertiaAgreesWithASumOfDiscs) {
    ShapeLibrary shapes;
    const double r = 0.3;
    const double h = 0.7;
    const Vec3 inertia = solid_inertia(shapes.at(shapes.add_capsule(r, h)), 5.0);
    double volume = 0.0;
    double along = 0.0;
    double across = 0.0;
    const auto add = [&](double y, double weight) {
        const double past = std::max(0.0, std::abs(y) - h);
        const double r2 = r * r - past * past;
        volume += weight * r2;
        along += weight * r2 * r2 / 2.0;
        across += weight * r2 * (r2 / 4.0 + y * y);
    };
    // The integrand is a polynomial in y of degree 4 at most, in the cylinder and in each cap.
    const auto integrate = [&](double from, double to) {
        constexpr int k_parts = 200;
        const double step = (to - from) / k_parts;
        for (int i = 0; i < k_parts; ++i) {
            add(from + i * step, step / 6.0);
            add(from + (i + 0.5) * step, step * 4.0 / 6.0);
            add(from + (i + 1) * step, step / 6.0);
        }
    };
    integrate(-h - r, -h);
    integrate(-h, h);
    integrate(h, h + r);
    EXPECT_NEAR(inertia.y(), 5.0 * along / volume, 1e-9);
    EXPECT_NEAR(inertia.x(), 5.0 * across / volume, 1e-9);
    EXPECT_EQ(inertia.x(), inertia.z());
}

TEST(ShapeLibrary, BoxAndSphereInertiaMatchTheClosedForms) {
    ShapeLibrary shapes;
    const Vec3 box = solid_inertia(shapes.at(shapes.add_box({0.5, 1.0, 1.5})), 12.0);
    EXPECT_TRUE(
        box.isApprox(Vec3(4.0 + 9.0, 1.0 + 9.0, 1.0 + 4.0), 1e-14));  // m/12 of the squared edges
    EXPECT_TRUE(solid_inertia(shapes.at(shapes.add_sphere(2.0)), 10.0)
                    .isApprox(Vec3::Constant(16.0), 1e-14));
}

}  // namespace
}  // namespace handhold::collision_shape_library_test

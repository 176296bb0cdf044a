#include <gtest/gtest.h>

#include "engine/core/check.hpp"
#include "engine/geometry/mass_properties.hpp"
#include "tests/engine/collision/scene.hpp"

// Expected values: textbook closed forms of boxes and cylinders, combined.
namespace handhold::collision_mass_test {
namespace {

using test::at;
using test::Random;

std::vector<Vec3> box_corners(const Vec3& half, const Pose& pose) {
    std::vector<Vec3> corners;
    for (unsigned i = 0; i < 8; ++i) {
        const Vec3 side((i & 1U) != 0 ? 1.0 : -1.0, (i & 2U) != 0 ? 1.0 : -1.0,
                        (i & 4U) != 0 ? 1.0 : -1.0);
        corners.push_back(transform_point(pose, side.cwiseProduct(half)));
    }
    return corners;
}

void expect_near(const Mat3& a, const Mat3& b, double tolerance) {
    EXPECT_LT((a - b).cwiseAbs().maxCoeff(), tolerance);
}

TEST(MassProperties, CylinderMatchesTheClosedForm) {
    ShapeLibrary shapes;
    const Shape& shape = shapes.at(shapes.add_cylinder(0.3, 0.5));
    const MassProperties p = mass_properties(shape);
    EXPECT_NEAR(p.volume_m3, 3.14159265358979 * 0.09 * 1.0, 1e-14);
    const Vec3 inertia = solid_inertia(shape, 12.0);
    EXPECT_NEAR(inertia.y(), 12.0 * 0.09 / 2.0, 1e-14);
    EXPECT_NEAR(inertia.x(), 12.0 * (3.0 * 0.09 + 1.0) / 12.0, 1e-14);
    EXPECT_EQ(inertia.z(), inertia.x());
    EXPECT_DOUBLE_EQ(bounding_radius(shape), std::sqrt(0.34));
    EXPECT_DOUBLE_EQ(thinnest_half_extent(shape), 0.3);
}

TEST(MassProperties, HullOfABoxMatchesTheBox) {
    Random random(81);
    for (int round = 0; round < 50; ++round) {
        const Vec3 half{random.between(0.05, 1.0), random.between(0.05, 1.0),
                        random.between(0.05, 1.0)};
        const Pose pose = random.pose(3.0);
        ShapeLibrary shapes;
        const Shape& hull = shapes.at(shapes.add_hull(box_corners(half, pose)));
        const MassProperties p = mass_properties(hull);
        EXPECT_NEAR(p.volume_m3, 8.0 * half.prod(), 1e-12);
        EXPECT_LT((p.centre_m - pose.position).norm(), 1e-12);
        ShapeLibrary boxes;
        const Vec3 moments = solid_inertia(boxes.at(boxes.add_box(half)), 1.0);
        const Mat3 turn = pose.rotation.toRotationMatrix();
        expect_near(p.inertia_per_kg_m2, turn * moments.asDiagonal() * turn.transpose(), 1e-12);
        EXPECT_NEAR(thinnest_half_extent(hull), half.minCoeff(), 1e-12);
    }
}

TEST(MassProperties, TetrahedronMatchesTheClosedForm) {
    // Right-angled, legs of length 1: volume 1/6, centre at 1/4, int x^2 = 1/60, int x y = 1/120.
    ShapeLibrary shapes;
    const std::vector<Vec3> corners = {Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
    const MassProperties p = mass_properties(shapes.at(shapes.add_hull(corners)));
    EXPECT_NEAR(p.volume_m3, 1.0 / 6.0, 1e-15);
    EXPECT_LT((p.centre_m - Vec3::Constant(0.25)).norm(), 1e-15);
    const double square = 6.0 / 60.0 - 1.0 / 16.0;
    const double product = 6.0 / 120.0 - 1.0 / 16.0;
    EXPECT_NEAR(p.inertia_per_kg_m2(0, 0), 2.0 * square, 1e-15);
    EXPECT_NEAR(p.inertia_per_kg_m2(0, 1), -product, 1e-15);
}

TEST(MassProperties, CompoundOfABoxesPartsMatchesTheBox) {
    // A box cut into parts of one density and reassembled.
    Random random(82);
    ShapeLibrary shapes;
    const ShapeId left = shapes.add_box({0.1, 0.2, 0.3});
    const ShapeId right = shapes.add_box({0.3, 0.2, 0.3});
    const ShapeId whole = shapes.add_box({0.4, 0.2, 0.3});
    const Vec3 moments = solid_inertia(shapes.at(whole), 7.0);
    for (int round = 0; round < 20; ++round) {
        const Pose pose = random.pose(2.0);
        const std::vector<CompoundChild> cut = {
            {left, pose * at({-0.3, 0.0, 0.0}), 0.0},
            {right, pose * at({0.1, 0.0, 0.0}), 0.0},
        };
        const CentredShape centred = shapes.add_centred(shapes.add_compound(cut));
        EXPECT_LT((centred.frame.position - pose.position).norm(), 1e-12);
        Vec3 found = solid_inertia(shapes.at(centred.shape), 7.0);
        Vec3 expected = moments;
        std::sort(found.begin(), found.end());
        std::sort(expected.begin(), expected.end());
        EXPECT_LT((found - expected).norm(), 1e-11);
    }
}

TEST(MassProperties, GivenMassesMoveTheCentre) {
    ShapeLibrary shapes;
    const ShapeId ball = shapes.add_sphere(0.1);
    const std::vector<CompoundChild> dumbbell = {{ball, at({0.0, 0.0, 0.0}), 3.0},
                                                 {ball, at({1.0, 0.0, 0.0}), 1.0}};
    const ShapeId id = shapes.add_compound(dumbbell);
    const MassProperties p = mass_properties(shapes.at(id));
    EXPECT_LT((p.centre_m - Vec3(0.25, 0.0, 0.0)).norm(), 1e-15);
    // 4 kg: two balls, and 3/4 m kg at distance 1.
    EXPECT_NEAR(4.0 * p.inertia_per_kg_m2(1, 1), 4.0 * 0.4 * 0.01 + 0.75, 1e-14);
    EXPECT_THROW(solid_inertia(shapes.at(id), 4.0), PreconditionError);  // not about its centre
}

TEST(AddCentred, KeepsTheSolidInPlace) {
    // A corner of the old shape, seen from the new frame, is a corner of the new one.
    Random random(83);
    for (int round = 0; round < 100; ++round) {
        std::vector<Vec3> points(20);
        const Vec3 middle = random.vector(3.0);
        for (Vec3& point : points) {
            point = middle + random.vector(1.0).cwiseProduct(Vec3(1.0, 0.4, 0.2));
        }
        ShapeLibrary shapes;
        const ShapeId id = shapes.add_hull(points);
        const CentredShape centred = shapes.add_centred(id);
        ASSERT_NO_THROW(solid_inertia(shapes.at(centred.shape), 1.0));
        const auto& before = shapes.at(id).hull->corners;
        const auto& after = shapes.at(centred.shape).hull->corners;
        for (std::size_t i = 0; i < before.size(); ++i) {
            ASSERT_LT((transform_point(centred.frame, after[i]) - before[i]).norm(), 1e-12);
        }
        // Recentring is idempotent.
        const CentredShape again = shapes.add_centred(centred.shape);
        ASSERT_EQ(again.shape, centred.shape);
        ASSERT_EQ(again.frame.position, Vec3::Zero());
    }
}

TEST(AddCentred, ChoosesTheAxesNearestToTheShapes) {
    ShapeLibrary shapes;
    const Pose pose = at({1.0, 2.0, 3.0}, rotation_about(Vec3(1.0, 1.0, 0.0).normalized(), 0.3));
    const ShapeId hull = shapes.add_hull(box_corners({0.1, 0.2, 0.5}, pose));
    const CentredShape centred = shapes.add_centred(hull);
    EXPECT_LT(rotation_to_vector(centred.frame.rotation.conjugate() * pose.rotation).norm(), 1e-9);
}

}  // namespace
}  // namespace handhold::collision_mass_test

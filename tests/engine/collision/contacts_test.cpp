#include <cmath>

#include <gtest/gtest.h>

#include "tests/engine/collision/scene.hpp"

// Resting bodies on a flat floor (the top of a box, or a mesh of many triangles). Every separation
// has a closed form.
namespace handhold::collision_contacts_test {
namespace {

using test::at;
using test::contacts_of;
using test::Random;
using test::resting;

constexpr double k_tolerance_m = 1e-9;
constexpr std::array<double, 5> k_gaps_m = {0.015, 0.003, 0.0, -0.001, -0.02};

enum class Ground { box, mesh, mixed_mesh };

struct Rest {
    const char* name;
    Quat rotation;
    double height_m;     // height of the centre above the floor at touch
    std::size_t points;  // number of lowest points, all of which must be in the manifold
};

struct Scene {
    ShapeLibrary shapes;
    ShapeId ground;
    Pose ground_pose;
};

Scene make_ground(Ground kind) {
    Scene scene;
    if (kind == Ground::box) {
        scene.ground = scene.shapes.add_box({2.0, 0.5, 2.0});
        scene.ground_pose = at({0.0, -0.5, 0.0});
    } else {
        const auto winding = kind == Ground::mesh ? test::Winding::up : test::Winding::mixed;
        scene.ground = scene.shapes.add_mesh(test::make_floor(4.0, 20, winding));
    }
    return scene;
}

// Checks the contacts of a body above or in the floor for each gap, with the scene transformed by
// `world`.
void expect_rest(Ground ground, const Shape& shape, const Rest& rest, const Pose& world,
                 double tolerance_m) {
    Scene scene = make_ground(ground);
    ShapeId body;
    switch (shape.kind) {
        case ShapeKind::box:
            body = scene.shapes.add_box(shape.half_m);
            break;
        case ShapeKind::sphere:
            body = scene.shapes.add_sphere(shape.radius_m);
            break;
        default:
            body = scene.shapes.add_capsule(shape.radius_m, shape.half_height_m);
            break;
    }
    for (const double gap : k_gaps_m) {
        const Pose pose = at({0.137, rest.height_m + gap, 0.071}, rest.rotation);
        const auto contacts =
            contacts_of(scene.shapes, {resting(1, scene.ground, world * scene.ground_pose, false),
                                       resting(2, body, world * pose, true)});
        SCOPED_TRACE(testing::Message() << rest.name << " gap " << gap);
        std::size_t level = 0;
        for (const ContactPoint& contact : contacts) {
            EXPECT_EQ(contact.id_a, 2U);
            EXPECT_EQ(contact.id_b, 1U);
            EXPECT_NEAR((contact.normal_b_bs - Vec3::UnitY()).norm(), 0.0, 1e-9);
            EXPECT_GE(contact.separation_m, gap - tolerance_m);
            level += std::abs(contact.separation_m - gap) < tolerance_m ? 1U : 0U;
            const Vec3 point_a = transform_point(world * pose, contact.point_a_bs);
            const Vec3 point_b = transform_point(world * scene.ground_pose, contact.point_b_bs);
            const Vec3 normal = (world * scene.ground_pose).rotation * contact.normal_b_bs;
            EXPECT_NEAR(normal.dot(point_a - point_b), contact.separation_m, tolerance_m);
        }
        EXPECT_EQ(level, rest.points);
    }
}

Shape box_shape() {
    Shape shape;
    shape.kind = ShapeKind::box;
    shape.half_m = {0.08, 0.05, 0.11};
    return shape;
}

std::vector<Rest> box_rests() {
    const Vec3 h = box_shape().half_m;
    const double quarter = 1.57079632679489661923;
    const double diagonal = std::hypot(h.x(), h.y());
    // Rotated so that the edge along z, or the corner, is straight below the centre.
    const Quat edge = rotation_between(Vec3(h.x(), h.y(), 0.0).normalized(), -Vec3::UnitY());
    const Quat corner = rotation_between(h.normalized(), -Vec3::UnitY());
    return {{"face y", rotation_about(Vec3::UnitY(), 0.3), h.y(), 4},
            {"face x", rotation_about(Vec3::UnitZ(), quarter), h.x(), 4},
            {"face z", rotation_about(Vec3::UnitX(), quarter), h.z(), 4},
            {"edge z", edge, diagonal, 2},
            {"corner", corner, h.norm(), 1}};
}

TEST(Contacts, BoxRestsOnFacesEdgesAndCorners) {
    for (const Ground ground : {Ground::box, Ground::mesh, Ground::mixed_mesh}) {
        for (const Rest& rest : box_rests()) {
            expect_rest(ground, box_shape(), rest, {}, k_tolerance_m);
        }
    }
}

TEST(Contacts, SphereTouchesAtOnePoint) {
    Shape sphere;
    sphere.radius_m = 0.12;
    for (const Ground ground : {Ground::box, Ground::mesh, Ground::mixed_mesh}) {
        expect_rest(ground, sphere, {"sphere", Quat::Identity(), 0.12, 1}, {}, k_tolerance_m);
    }
}

TEST(Contacts, CapsuleLiesOnTwoPointsAndStandsOnOne) {
    Shape capsule;
    capsule.kind = ShapeKind::capsule;
    capsule.radius_m = 0.06;
    capsule.half_height_m = 0.2;
    const Quat lying =
        rotation_about(Vec3::UnitY(), 0.4) * rotation_about(Vec3::UnitZ(), 1.57079632679489661923);
    const Quat leaning = rotation_about(Vec3::UnitZ(), 0.5);
    for (const Ground ground : {Ground::box, Ground::mesh, Ground::mixed_mesh}) {
        expect_rest(ground, capsule, {"lying", lying, 0.06, 2}, {}, k_tolerance_m);
        expect_rest(ground, capsule, {"standing", Quat::Identity(), 0.26, 1}, {}, k_tolerance_m);
        expect_rest(ground, capsule, {"leaning", leaning, 0.06 + 0.2 * std::cos(0.5), 1}, {},
                    k_tolerance_m);
    }
}

TEST(Contacts, StayExactFarFromTheOriginAndRotated) {
    Random random(11);
    for (const double distance_m : {1e4, 1e5}) {
        for (int round = 0; round < 4; ++round) {
            const Pose world{distance_m * random.direction(), random.rotation()};
            for (const Ground ground : {Ground::box, Ground::mesh}) {
                for (const Rest& rest : box_rests()) {
                    expect_rest(ground, box_shape(), rest, world, 1e-7);
                }
            }
        }
    }
}

TEST(Contacts, EndAtTheMargin) {
    ShapeLibrary shapes;
    const ShapeId ball = shapes.add_sphere(0.1);
    const auto count = [&](double gap, double margin) {
        return contacts_of(shapes,
                           {resting(1, ball, at({0.0, 0.0, 0.0}), false),
                            resting(2, ball, at({0.0, 0.2 + gap, 0.0}), true)},
                           {margin, 0.005})
            .size();
    };
    EXPECT_EQ(count(0.0199, 0.02), 1U);
    EXPECT_EQ(count(0.0201, 0.02), 0U);
    EXPECT_EQ(count(0.0999, 0.1), 1U);
}

TEST(Contacts, TwoSpheresTouchOnTheLineBetweenTheirCentres) {
    Random random(12);
    ShapeLibrary shapes;
    const ShapeId small = shapes.add_sphere(0.07);
    const ShapeId large = shapes.add_sphere(0.3);
    for (int round = 0; round < 50; ++round) {
        const Vec3 direction = random.direction();
        const double distance = random.between(0.05, 0.38);
        const Pose a = random.pose(1.0);
        const Pose b = at(a.position + distance * direction, random.rotation());
        const auto contacts =
            contacts_of(shapes, {resting(1, small, a, true), resting(2, large, b, true)});
        ASSERT_EQ(contacts.size(), 1U);
        EXPECT_NEAR(contacts[0].separation_m, distance - 0.37, 1e-12);
        EXPECT_NEAR((b.rotation * contacts[0].normal_b_bs + direction).norm(), 0.0, 1e-12);
        EXPECT_NEAR(contacts[0].point_a_bs.norm(), 0.07, 1e-12);
        EXPECT_NEAR(contacts[0].point_b_bs.norm(), 0.3, 1e-12);
    }
}

TEST(Contacts, ParallelCapsulesTouchAtBothEndsOfTheirCommonPart) {
    ShapeLibrary shapes;
    const ShapeId capsule = shapes.add_capsule(0.05, 0.2);
    const auto contacts = contacts_of(shapes, {resting(1, capsule, at({0.0, 0.0, 0.0}), false),
                                               resting(2, capsule, at({0.105, 0.1, 0.0}), true)});
    ASSERT_EQ(contacts.size(), 2U);
    for (const ContactPoint& contact : contacts) {
        EXPECT_NEAR(contact.separation_m, 0.005, 1e-12);
        EXPECT_NEAR(contact.normal_b_bs.x(), 1.0, 1e-12);
    }
    EXPECT_NEAR(contacts[0].point_b_bs.y(), -0.1,
                1e-9);  // they overlap from -0.1 to 0.2
    EXPECT_NEAR(contacts[1].point_b_bs.y(), 0.2, 1e-9);
}

TEST(Contacts, BoxOverhangingABoxTouchesOnlyTheCommonPart) {
    ShapeLibrary shapes;
    const ShapeId cube = shapes.add_box(Vec3::Constant(0.1));
    const auto contacts = contacts_of(shapes, {resting(1, cube, at({0.0, 0.0, 0.0}), false),
                                               resting(2, cube, at({0.15, 0.199, 0.0}), true)});
    ASSERT_EQ(contacts.size(), 4U);
    for (const ContactPoint& contact : contacts) {
        EXPECT_NEAR(contact.separation_m, -0.001, 1e-12);
        EXPECT_NEAR(std::abs(contact.point_b_bs.x() - 0.075), 0.025, 1e-8);
        EXPECT_NEAR(std::abs(contact.point_b_bs.z()), 0.1, 1e-8);
    }
}

TEST(Contacts, DisjointEdgesAreSeparatedAlongTheirShortestConnection) {
    // 5 mm apart along x and along y: an axis test says 5 mm, the distance is 7.07 mm.
    ShapeLibrary shapes;
    const ShapeId cube = shapes.add_box(Vec3::Constant(0.1));
    const auto contacts = contacts_of(shapes, {resting(1, cube, at({0.0, 0.0, 0.0}), false),
                                               resting(2, cube, at({0.205, 0.205, 0.02}), true)});
    ASSERT_EQ(contacts.size(), 2U);
    for (const ContactPoint& contact : contacts) {
        EXPECT_NEAR(contact.separation_m, 0.005 * std::sqrt(2.0), 1e-12);
    }
}

TEST(Contacts, DeepConvexPairsTakeTheShortestExit) {
    ShapeLibrary shapes;
    const ShapeId cube = shapes.add_box({0.1, 0.3, 0.3});
    const ShapeId ball = shapes.add_sphere(0.05);
    const auto contacts = contacts_of(shapes, {resting(1, cube, at({0.0, 0.0, 0.0}), false),
                                               resting(2, ball, at({-0.02, 0.1, 0.0}), true)});
    ASSERT_EQ(contacts.size(), 1U);
    EXPECT_NEAR(contacts[0].separation_m, -(0.08 + 0.05), 1e-12);
    EXPECT_NEAR(contacts[0].normal_b_bs.x(), -1.0, 1e-12);
}

}  // namespace
}  // namespace handhold::collision_contacts_test

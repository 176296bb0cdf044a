#include <cmath>

#include <gtest/gtest.h>

#include "tests/engine/collision/oracle.hpp"

// Cases that only meshes can get wrong: internal edges, sides, degenerate triangles.
namespace handhold::collision_mesh_test {
namespace {

using test::at;
using test::contacts_of;
using test::Random;
using test::resting;
using test::Winding;

double tilt_deg(const ContactPoint& contact, const Vec3& normal) {
    const double sine = contact.normal_b_bs.cross(normal).norm();
    return std::atan2(sine, contact.normal_b_bs.dot(normal)) * 57.29577951308232;
}

enum class BodyKind { sphere, box, capsule };

ShapeId add_body(ShapeLibrary& shapes, BodyKind kind) {
    switch (kind) {
        case BodyKind::sphere:
            return shapes.add_sphere(0.1);
        case BodyKind::box:
            return shapes.add_box({0.07, 0.1, 0.09});
        case BodyKind::capsule:
            break;
    }
    return shapes.add_capsule(0.1, 0.15);
}

Quat rest_rotation(BodyKind kind, double yaw) {
    const Quat turn = rotation_about(Vec3::UnitY(), yaw);
    return kind == BodyKind::capsule ? turn * rotation_about(Vec3::UnitZ(), 1.57079632679489661923)
                                     : turn;
}

TEST(MeshContacts, InternalEdgesTiltNoNormal) {
    Random random(21);
    for (const Winding winding : {Winding::up, Winding::down, Winding::mixed}) {
        for (const BodyKind kind : {BodyKind::sphere, BodyKind::box, BodyKind::capsule}) {
            ShapeLibrary shapes;
            const ShapeId floor = shapes.add_mesh(test::make_floor(2.0, 23, winding));
            const ShapeId body = add_body(shapes, kind);
            for (int round = 0; round < 60; ++round) {
                const double gap = random.between(-0.015, 0.015);
                const Pose pose{{random.between(-0.6, 0.6), 0.1 + gap, random.between(-0.6, 0.6)},
                                rest_rotation(kind, random.between(-3.0, 3.0))};
                const auto contacts = contacts_of(
                    shapes, {resting(1, floor, {}, false), resting(2, body, pose, true)});
                ASSERT_FALSE(contacts.empty());
                for (const ContactPoint& contact : contacts) {
                    ASSERT_LE(tilt_deg(contact, Vec3::UnitY()), 1e-4);
                    ASSERT_NEAR(contact.separation_m, gap, 1e-9);
                }
            }
        }
    }
}

TEST(MeshContacts, BoxOnAFineFloorKeepsOnlyTheCornersOfItsFace) {
    ShapeLibrary shapes;
    // 2.5 cm squares.
    const ShapeId floor = shapes.add_mesh(test::make_floor(2.0, 80, Winding::mixed));
    const ShapeId box = shapes.add_box({0.2, 0.1, 0.15});
    const Pose pose = at({0.013, 0.099, 0.007}, rotation_about(Vec3::UnitY(), 0.3));
    const auto contacts =
        contacts_of(shapes, {resting(1, floor, {}, false), resting(2, box, pose, true)});
    ASSERT_EQ(contacts.size(), 4U);
    for (const ContactPoint& contact : contacts) {
        EXPECT_NEAR(std::abs(contact.point_a_bs.x()), 0.2, 1e-6);
        EXPECT_NEAR(std::abs(contact.point_a_bs.z()), 0.15, 1e-6);
    }
}

TEST(MeshContacts, TJunctionsAndCracksTiltNoNormal) {
    // One large square next to a row of small ones: vertices lie on the large one's edge, and the
    // parts are disjoint, 5 um apart.
    auto mesh = std::make_shared<Mesh>();
    const auto add_square = [&](double x0, double x1, double z0, double z1) {
        const auto base = static_cast<std::uint32_t>(mesh->positions.size());
        mesh->positions.insert(mesh->positions.end(),
                               {{x0, 0.0, z0}, {x1, 0.0, z0}, {x1, 0.0, z1}, {x0, 0.0, z1}});
        mesh->triangles.push_back({base, base + 1, base + 2});
        mesh->triangles.push_back({base, base + 2, base + 3});
    };
    add_square(-1.0, 0.0, -1.0, 1.0);
    for (int i = -7; i < 7; ++i) {
        add_square(5e-6, 1.0, i / 7.0, (i + 1) / 7.0);
    }
    ShapeLibrary shapes;
    const ShapeId floor = shapes.add_mesh(mesh);
    const ShapeId ball = shapes.add_sphere(0.1);
    const ShapeId box = shapes.add_box(Vec3::Constant(0.1));
    for (const ShapeId body : {ball, box}) {
        for (int i = -20; i <= 20; ++i) {
            for (const double gap : {0.004, -0.004}) {
                const auto contacts =
                    contacts_of(shapes, {resting(1, floor, {}, false),
                                         resting(2, body, at({0.006 * i, 0.1 + gap, 0.21}), true)});
                ASSERT_FALSE(contacts.empty());
                for (const ContactPoint& contact : contacts) {
                    ASSERT_LE(tilt_deg(contact, Vec3::UnitY()), 1e-4) << i << " " << gap;
                    ASSERT_NEAR(contact.separation_m, gap, 1e-9);
                }
            }
        }
    }
}

TEST(MeshContacts, OpenEdgePushesSideways) {
    ShapeLibrary shapes;
    const ShapeId sheet = shapes.add_mesh(test::make_floor(1.0, 4));
    const ShapeId ball = shapes.add_sphere(0.1);
    // Beside the sheet's rim, at its height: pushed straight away from the rim.
    const auto contacts = contacts_of(
        shapes, {resting(1, sheet, {}, false), resting(2, ball, at({0.598, 0.0, 0.03}), true)});
    ASSERT_EQ(contacts.size(), 1U);
    EXPECT_NEAR(contacts[0].separation_m, -0.002, 1e-12);
    EXPECT_NEAR(contacts[0].normal_b_bs.x(), 1.0, 1e-12);
}

TEST(MeshContacts, BoxOverAStepsEdgeIsSupportedFromBelowOnly) {
    ShapeLibrary shapes;
    const ShapeId step = shapes.add_mesh(test::make_box_mesh({0.5, 0.5, 0.5}));
    const ShapeId box = shapes.add_box(Vec3::Constant(0.1));
    // The centre crosses the plane of the step's front; half the box hangs over.
    ColliderProxy body = resting(2, box, at({0.498, 0.599, 0.0}), true);
    body.to_ws = at({0.502, 0.599, 0.0});
    for (const double sweep_m : {0.005, 0.001}) {
        const auto contacts =
            contacts_of(shapes, {resting(1, step, {}, false), body}, {0.02, sweep_m});
        ASSERT_GE(contacts.size(), 4U);
        for (const ContactPoint& contact : contacts) {
            EXPECT_NEAR(contact.normal_b_bs.y(), 1.0, 1e-12);
            EXPECT_NEAR(contact.separation_m, -0.001, 1e-9);
        }
    }
}

TEST(MeshContacts, TiltedPlankOnAnEdgeIsSupportedAtTheEdge) {
    // The plank's underside faces away from the step's front, although its centre lies behind the
    // front's plane.
    ShapeLibrary shapes;
    const ShapeId step = shapes.add_mesh(test::make_box_mesh({0.5, 0.5, 0.5}));
    const ShapeId plank = shapes.add_box({0.4, 0.02, 0.1});
    const Quat tilt = rotation_about(Vec3::UnitZ(), -0.7);
    const Vec3 up = tilt * Vec3::UnitY();
    const Vec3 along = tilt * Vec3::UnitX();
    const Vec3 centre = Vec3(0.5, 0.5, 0.0) + 0.019 * up - 0.1 * along;
    ASSERT_LT(centre.x(), 0.5);
    const auto contacts = contacts_of(
        shapes, {resting(1, step, {}, false), resting(2, plank, at(centre, tilt), true)});
    ASSERT_EQ(contacts.size(), 2U);
    for (const ContactPoint& contact : contacts) {
        EXPECT_NEAR((contact.normal_b_bs - up).norm(), 0.0, 1e-9);
        EXPECT_NEAR(contact.separation_m, -0.001, 1e-9);
    }
}

// A wall in the plane y = 0. The body comes from above and ends with its centre below.
struct Crossing {
    BodyKind kind;
    double end_y_m;
    double expected_depth_m;  // closed form: the centre's height minus the half extent along y
};

TEST(MeshContacts, BodyThroughAWallIsPushedToTheSideItCameFrom) {
    for (const Winding winding : {Winding::up, Winding::down, Winding::mixed}) {
        for (const std::uint32_t cells : {1U, 40U}) {
            ShapeLibrary shapes;
            const ShapeId wall = shapes.add_mesh(test::make_floor(4.0, cells, winding));
            // 3/4 through: half extent 0.1, centre 0.05 beyond the wall
            for (const Crossing& c :
                 {Crossing{BodyKind::box, -0.05, -0.15}, Crossing{BodyKind::sphere, -0.05, -0.15},
                  Crossing{BodyKind::capsule, -0.05, -0.15}}) {
                const ShapeId body = add_body(shapes, c.kind);
                const Quat rotation = rest_rotation(c.kind, 0.3);
                ColliderProxy proxy = resting(2, body, at({0.031, 0.12, 0.017}, rotation), true);
                proxy.to_ws.position.y() = c.end_y_m;
                for (const double sweep_m : {1.0, 0.005}) {
                    SCOPED_TRACE(testing::Message() << "cells " << cells << " sweep " << sweep_m);
                    const auto contacts =
                        contacts_of(shapes, {resting(1, wall, {}, false), proxy}, {0.02, sweep_m});
                    ASSERT_GE(contacts.size(), c.kind == BodyKind::box ? 4U : 1U);
                    for (const ContactPoint& contact : contacts) {
                        EXPECT_NEAR(contact.normal_b_bs.y(), 1.0, 1e-9);
                        EXPECT_NEAR(contact.separation_m, c.expected_depth_m, 1e-6);
                    }
                }
            }
        }
    }
}

TEST(MeshContacts, MovingWallPushesToTheSideTheBodyCameFrom) {
    // The wall moves 0.2 m through a resting box: relative to the wall the box came from above.
    ShapeLibrary shapes;
    const ShapeId wall = shapes.add_mesh(test::make_floor(4.0, 10, Winding::mixed));
    const ShapeId box = shapes.add_box(Vec3::Constant(0.1));
    ColliderProxy ship{1, wall, at({0.0, -0.12, 0.0}), at({0.0, 0.08, 0.0}), false};
    for (const double sweep_m : {1.0, 0.005}) {
        const auto contacts =
            contacts_of(shapes, {ship, resting(2, box, {}, true)}, {0.02, sweep_m});
        ASSERT_GE(contacts.size(), 4U);
        EXPECT_NEAR(test::deepest(contacts), -0.18, 1e-6);
        EXPECT_NEAR(contacts[0].normal_b_bs.y(), 1.0, 1e-9);
    }
}

TEST(MeshContacts, DegenerateTrianglesChangeNothing) {
    auto mesh = test::make_floor(2.0, 9);
    const auto base = static_cast<std::uint32_t>(mesh->positions.size());
    mesh->positions.insert(
        mesh->positions.end(),
        {{-0.9, 0.0, 0.01}, {0.9, 0.0, 0.01}, {0.1, 0.0, 0.01 + 1e-7}, {0.1, 0.0, 0.01}});
    mesh->triangles.push_back({base, base + 1, base + 2});
    mesh->triangles.push_back({base, base + 1, base + 3});
    mesh->triangles.push_back({base, base, base});
    ShapeLibrary shapes;
    const ShapeId floor = shapes.add_mesh(mesh);
    for (const BodyKind kind : {BodyKind::sphere, BodyKind::box, BodyKind::capsule}) {
        const Pose pose = at({0.1, 0.097, 0.02}, rest_rotation(kind, 0.2));
        const auto contacts = contacts_of(
            shapes, {resting(1, floor, {}, false), resting(2, add_body(shapes, kind), pose, true)});
        ASSERT_FALSE(contacts.empty());
        for (const ContactPoint& contact : contacts) {
            EXPECT_LE(tilt_deg(contact, Vec3::UnitY()), 1e-4);
            EXPECT_NEAR(contact.separation_m, -0.003, 1e-9);
        }
    }
}

TEST(MeshContacts, BoxInACornerTouchesFloorAndWall) {
    auto mesh = test::make_floor(2.0, 11);
    test::add_wall(*mesh);
    ShapeLibrary shapes;
    const ShapeId corner = shapes.add_mesh(mesh);
    const ShapeId box = shapes.add_box(Vec3::Constant(0.1));
    const auto contacts = contacts_of(
        shapes, {resting(1, corner, {}, false), resting(2, box, at({0.202, 0.099, 0.0}), true)});
    int on_floor = 0;
    int on_wall = 0;
    for (const ContactPoint& contact : contacts) {
        const bool floor = contact.normal_b_bs.y() > 0.5;
        EXPECT_LE(tilt_deg(contact, floor ? Vec3(Vec3::UnitY()) : Vec3(-Vec3::UnitX())), 1e-4);
        EXPECT_NEAR(contact.separation_m, floor ? -0.001 : -0.002, 1e-9);
        (floor ? on_floor : on_wall) += 1;
    }
    EXPECT_EQ(on_floor, 4);
    EXPECT_EQ(on_wall, 4);
}

}  // namespace
}  // namespace handhold::collision_mesh_test

#include <cmath>
#include <filesystem>
#include <optional>

#include <gtest/gtest.h>

#include "engine/io/gltf.hpp"
#include "tests/engine/collision/oracle.hpp"
#include "tests/places.hpp"

// What meshes alone can get wrong: internal edges, sides, slivers.
namespace handhold::collision_mesh_test {
namespace {

using test::at;
using test::contacts_of;
using test::Random;
using test::resting;
using test::Winding;

double bend_deg(const ContactPoint& contact, const Vec3& normal) {
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

TEST(MeshContacts, InternalEdgesBendNoNormal) {
    Random random(21);
    for (const Winding winding : {Winding::up, Winding::down, Winding::mixed}) {
        for (const BodyKind kind : {BodyKind::sphere, BodyKind::box, BodyKind::capsule}) {
            ShapeLibrary shapes;
            const ShapeId floor = shapes.add_mesh(test::make_floor(2.0, 23, winding));
            const ShapeId body = add_body(shapes, kind);
            for (int round = 0; round < 60; ++round) {
                const double gap = random.between(-0.015, 0.015);
                const Pose pose =
                    at({random.between(-0.6, 0.6), 0.1 + gap, random.between(-0.6, 0.6)},
                       rest_rotation(kind, random.between(-3.0, 3.0)));
                const auto contacts = contacts_of(
                    shapes, {resting(1, floor, {}, false), resting(2, body, pose, true)});
                ASSERT_FALSE(contacts.empty());
                for (const ContactPoint& contact : contacts) {
                    ASSERT_LE(bend_deg(contact, Vec3::UnitY()), 1e-4);
                    ASSERT_NEAR(contact.separation_m, gap, 1e-9);
                }
            }
        }
    }
}

TEST(MeshContacts, BoxOnAFineFloorKeepsOnlyTheCornersOfItsFace) {
    ShapeLibrary shapes;
    const ShapeId floor =
        shapes.add_mesh(test::make_floor(2.0, 80, Winding::mixed));  // 2.5 cm squares
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

TEST(MeshContacts, TJunctionsAndCracksBendNothing) {
    // One large square meets a row of small ones: vertices lie on the large one's edge, parts are
    // not joined, and 5 um apart.
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
                    ASSERT_LE(bend_deg(contact, Vec3::UnitY()), 1e-4) << i << " " << gap;
                    ASSERT_NEAR(contact.separation_m, gap, 1e-9);
                }
            }
        }
    }
}

TEST(MeshContacts, OpenEdgesAreStillEdges) {
    ShapeLibrary shapes;
    const ShapeId sheet = shapes.add_mesh(test::make_floor(1.0, 4));
    const ShapeId ball = shapes.add_sphere(0.1);
    // Beside the sheet's rim at its height: pushed straight out of the rim.
    const auto contacts = contacts_of(
        shapes, {resting(1, sheet, {}, false), resting(2, ball, at({0.598, 0.0, 0.03}), true)});
    ASSERT_EQ(contacts.size(), 1U);
    EXPECT_NEAR(contacts[0].separation_m, -0.002, 1e-12);
    EXPECT_NEAR(contacts[0].normal_b_bs.x(), 1.0, 1e-12);
}

TEST(MeshContacts, BoxOverTheBrinkOfAStepIsHeldFromBelowOnly) {
    ShapeLibrary shapes;
    const ShapeId step = shapes.add_mesh(test::make_box_mesh({0.5, 0.5, 0.5}));
    const ShapeId box = shapes.add_box(Vec3::Constant(0.1));
    // The centre crosses the plane of the step's front, half the box hangs over.
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

TEST(MeshContacts, TiltedPlankOnABrinkIsHeldAtTheBrink) {
    // The plank's underside faces away from the step's front although its centre lies behind that
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

// A wall in the plane y = 0 again; the body comes from above and ends with its centre below.
struct Crossing {
    BodyKind kind;
    double end_y_m;
    double expected_depth_m;  // from the closed form: half extent along y minus the centre's height
};

TEST(MeshContacts, BodyThroughAOneSidedWallIsPushedBackWhereItCameFrom) {
    for (const Winding winding : {Winding::up, Winding::down, Winding::mixed}) {
        for (const std::uint32_t cells : {1U, 40U}) {
            ShapeLibrary shapes;
            const ShapeId wall = shapes.add_mesh(test::make_floor(4.0, cells, winding));
            // 3/4 through: half extent 0.1, the centre 0.05 beyond.
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

TEST(MeshContacts, WallFacesTheSideItWasMetFromOnAMovingShip) {
    // The wall itself moves 0.2 m through a resting box: relative to the wall the box came from
    // above.
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

TEST(MeshContacts, SliversAndTrianglesWithoutAreaDoNotDisturb) {
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
            EXPECT_LE(bend_deg(contact, Vec3::UnitY()), 1e-4);
            EXPECT_NEAR(contact.separation_m, -0.003, 1e-9);
        }
    }
}

TEST(MeshContacts, BoxInACornerMeetsFloorAndWall) {
    auto mesh = test::make_floor(2.0, 11);
    const auto base = static_cast<std::uint32_t>(mesh->positions.size());
    mesh->positions.insert(mesh->positions.end(),
                           {{0.3, 0.0, -1.0}, {0.3, 0.0, 1.0}, {0.3, 1.0, 1.0}, {0.3, 1.0, -1.0}});
    mesh->triangles.push_back({base, base + 1, base + 2});
    mesh->triangles.push_back({base, base + 2, base + 3});
    ShapeLibrary shapes;
    const ShapeId corner = shapes.add_mesh(mesh);
    const ShapeId box = shapes.add_box(Vec3::Constant(0.1));
    const auto contacts = contacts_of(
        shapes, {resting(1, corner, {}, false), resting(2, box, at({0.202, 0.099, 0.0}), true)});
    int on_floor = 0;
    int on_wall = 0;
    for (const ContactPoint& contact : contacts) {
        const bool floor = contact.normal_b_bs.y() > 0.5;
        EXPECT_LE(bend_deg(contact, floor ? Vec3(Vec3::UnitY()) : Vec3(-Vec3::UnitX())), 1e-4);
        EXPECT_NEAR(contact.separation_m, floor ? -0.001 : -0.002, 1e-9);
        (floor ? on_floor : on_wall) += 1;
    }
    EXPECT_EQ(on_floor, 4);
    EXPECT_EQ(on_wall, 4);
}

// The parts of a real level, each its own static collider.
struct Level {
    ShapeLibrary shapes;
    std::vector<ColliderProxy> parts;
    std::vector<std::shared_ptr<const Mesh>> meshes;
};

std::optional<Level> load_level() {
    const std::filesystem::path path = data_dir() / "level" / "station.glb";
    if (!std::filesystem::exists(path)) {
        return std::nullopt;
    }
    const Result<GltfLevel> file = load_gltf_level(path);
    EXPECT_TRUE(file.ok());
    Level level;
    for (const LevelPart& part : file.value().parts) {
        level.meshes.push_back(std::make_shared<Mesh>(part.mesh));
        level.parts.push_back(
            resting(level.parts.size() + 1, level.shapes.add_mesh(level.meshes.back()), {}, false));
    }
    return level;
}

// A place in the air of one of the modules, between two of its walls.
Vec3 place_in(const Mesh& mesh, Random& random) {
    const auto vertex = [&] {
        return mesh.positions[static_cast<std::size_t>(
            random.between(0.0, static_cast<double>(mesh.positions.size())))];
    };
    const Vec3 a = vertex();
    const Vec3 b = vertex();
    return a + random.between(0.0, 1.0) * (b - a);
}

// Visits the triangles with an area that come within reach_m of a point.
template <typename Visit>
void visit_near(const Level& level, const Vec3& point, double reach_m, const Visit& visit) {
    for (const auto& mesh : level.meshes) {
        for (const auto& t : mesh->triangles) {
            const Corners corners{mesh->positions[t[0]], mesh->positions[t[1]],
                                  mesh->positions[t[2]]};
            const Vec3 low = corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]);
            const Vec3 high = corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]);
            if ((point.cwiseMax(low).cwiseMin(high) - point).norm() < reach_m &&
                !area_vector(corners).isZero(0.0)) {
                visit(corners);
            }
        }
    }
}

// Oracle: the sphere's centre against every triangle, by the closest point's closed form.
TEST(MeshContacts, SphereInARealLevelIsAsDeepAsItsNearestTriangle) {
    auto level = load_level();
    if (!level) {
        GTEST_SKIP() << "no level data";
    }
    const double radius = 0.13;
    const ShapeId head = level->shapes.add_sphere(radius);
    CollisionWorld world(level->shapes);
    std::vector<ColliderProxy> proxies = level->parts;
    proxies.push_back(resting(1000, head, {}, true));
    std::vector<ContactPoint> contacts;
    Random random(22);
    int met = 0;
    for (int round = 0; round < 300; ++round) {
        const Vec3 centre = place_in(
            *level->meshes[static_cast<std::size_t>(round) % level->meshes.size()], random);
        proxies.back() = resting(1000, head, at(centre, random.rotation()), true);
        world.set_proxies(proxies);
        world.find_contacts({}, contacts);
        double nearest = 1e9;
        visit_near(*level, centre, 0.2, [&](const Corners& corners) {
            nearest = std::min(nearest, (closest_on_triangle(centre, corners) - centre).norm());
        });
        const double expected = nearest - radius;
        ASSERT_EQ(contacts.empty(), expected >= 0.02) << "at " << centre.transpose();
        if (!contacts.empty()) {
            ++met;
            ASSERT_NEAR(test::deepest(contacts), expected, 1e-9) << "at " << centre.transpose();
        }
    }
    EXPECT_GT(met, 100);
}

// Oracle: the exact distance of the box from every triangle near it.
TEST(MeshContacts, BoxInARealLevelIsAsNearAsItsNearestTriangle) {
    auto level = load_level();
    if (!level) {
        GTEST_SKIP() << "no level data";
    }
    const ShapeId box = level->shapes.add_box({0.15, 0.1, 0.12});
    CollisionWorld world(level->shapes);
    std::vector<ColliderProxy> proxies = level->parts;
    proxies.push_back(resting(1000, box, {}, true));
    const auto distance = [&](const Pose& pose) {
        const test::Core core = test::make_core(level->shapes.at(box), pose);
        test::Gap nearest;
        visit_near(*level, pose.position, 0.6, [&](const Corners& corners) {
            const test::Gap gap = test::gap_to_triangle(core, corners);
            nearest = gap.distance_m < nearest.distance_m ? gap : nearest;
        });
        return nearest;
    };
    std::vector<ContactPoint> contacts;
    Random random(23);
    int near = 0;
    for (int round = 0; round < 200; ++round) {
        Pose pose =
            at(place_in(*level->meshes[static_cast<std::size_t>(round) % level->meshes.size()],
                        random),
               random.rotation());
        // Brought up to the nearest surface, in steps, until it is a few millimetres away.
        test::Gap nearest = distance(pose);
        for (int step = 0; step < 4 && nearest.distance_m > 0.015 && nearest.distance_m < 1.0;
             ++step) {
            pose.position -= (nearest.distance_m - random.between(0.001, 0.015)) * nearest.normal;
            nearest = distance(pose);
        }
        proxies.back() = resting(1000, box, pose, true);
        world.set_proxies(proxies);
        world.find_contacts({}, contacts);
        if (nearest.distance_m > 1e-6) {
            ASSERT_EQ(contacts.empty(), nearest.distance_m >= 0.02);
            near += contacts.empty() ? 0 : 1;
            ASSERT_TRUE(contacts.empty() ||
                        std::abs(test::deepest(contacts) - nearest.distance_m) < 1e-6);
        } else {
            ASSERT_FALSE(contacts.empty());
        }
    }
    EXPECT_GT(near, 30);
}

}  // namespace
}  // namespace handhold::collision_mesh_test

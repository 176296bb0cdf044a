#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "tests/engine/collision/oracle.hpp"

// Bodies that move far in one frame: contacts at the first impact, depth at the end of the motion.
namespace handhold::collision_sweep_test {
namespace {

using test::at;
using test::contacts_of;
using test::Random;
using test::resting;

ColliderProxy moving(std::uint64_t id, ShapeId shape, const Pose& from, const Pose& to,
                     bool free = true) {
    return {id, shape, from, to, free};
}

TEST(Sweep, FastBoxStopsAtTheNearSideOfAThinBox) {
    ShapeLibrary shapes;
    const ShapeId wall = shapes.add_box({1.0, 0.005, 1.0});
    const ShapeId box = shapes.add_box(Vec3::Constant(0.1));
    const auto contacts = contacts_of(
        shapes,
        {resting(1, wall, {}, false), moving(2, box, at({0.0, 0.5, 0.0}), at({0.0, -2.0, 0.0}))});
    ASSERT_EQ(contacts.size(), 4U);
    for (const ContactPoint& contact : contacts) {
        EXPECT_NEAR(contact.normal_b_bs.y(), 1.0, 1e-12);
        EXPECT_NEAR(contact.separation_m, -2.0 - 0.105,
                    1e-9);  // depth of the centre below its resting height
        EXPECT_NEAR(contact.point_b_bs.y(), 0.005, 1e-12);
    }
}

TEST(Sweep, FastBoxStopsAtAMeshFromEitherSide) {
    ShapeLibrary shapes;
    const ShapeId wall = shapes.add_mesh(test::make_floor(4.0, 12, test::Winding::mixed));
    const ShapeId box = shapes.add_box(Vec3::Constant(0.1));
    for (const double side : {1.0, -1.0}) {
        const auto contacts = contacts_of(
            shapes, {resting(1, wall, {}, false),
                     moving(2, box, at({0.01, 0.5 * side, 0.02}), at({0.3, -2.0 * side, 0.1}))});
        ASSERT_GE(contacts.size(), 4U);
        for (const ContactPoint& contact : contacts) {
            EXPECT_NEAR(contact.normal_b_bs.y(), side, 1e-9);
            EXPECT_NEAR(contact.separation_m, -2.1, 1e-6);
        }
    }
}

TEST(Sweep, FreeBodiesStopEachOther) {
    ShapeLibrary shapes;
    const ShapeId ball = shapes.add_sphere(0.1);
    // Head on, 1 m each: they pass each other within the frame. Relative to b, a moves from -1 to
    // +1.
    const auto contacts =
        contacts_of(shapes, {moving(1, ball, at({-0.5, 0.0, 0.0}), at({0.5, 0.0, 0.0})),
                             moving(2, ball, at({0.5, 0.0, 0.0}), at({-0.5, 0.0, 0.0}))});
    ASSERT_EQ(contacts.size(), 1U);
    EXPECT_EQ(contacts[0].id_a, 1U);
    EXPECT_NEAR(contacts[0].normal_b_bs.x(), -1.0, 1e-12);
    EXPECT_NEAR(contacts[0].separation_m, -1.2, 1e-9);
}

TEST(Sweep, LeavingAndSlidingBodiesAreNotStopped) {
    ShapeLibrary shapes;
    const ShapeId floor = shapes.add_mesh(test::make_floor(4.0, 31, test::Winding::mixed));
    const ShapeId slab = shapes.add_box({2.0, 0.5, 2.0});
    const ShapeId box = shapes.add_box(Vec3::Constant(0.1));
    for (const auto& ground :
         {resting(1, floor, {}, false), resting(1, slab, at({0.0, -0.5, 0.0}), false)}) {
        for (const double height_m : {1e-7, 0.0, -1e-7, -1e-5, -0.001}) {
            // Sliding 0.7 m: the contacts are under the final position.
            const auto slid =
                contacts_of(shapes, {ground, moving(2, box, at({-0.3, 0.1 + height_m, 0.0}),
                                                    at({0.4, 0.1 + height_m, 0.1}))});
            ASSERT_GE(slid.size(), 4U) << height_m;
            for (const ContactPoint& contact : slid) {
                EXPECT_NEAR(contact.normal_b_bs.y(), 1.0, 1e-9) << height_m;
                EXPECT_NEAR(contact.separation_m, height_m, 1e-9);
                EXPECT_NEAR(contact.point_b_bs.x(), 0.4, 0.1001);
            }
            // Leaving upwards: not stopped.
            EXPECT_TRUE(contacts_of(shapes, {ground, moving(2, box, at({0.0, 0.1 + height_m, 0.0}),
                                                            at({0.0, 0.6, 0.0}))})
                            .empty());
        }
    }
}

TEST(Sweep, BodySlidingOverTheFloorIsStoppedByTheWallOfTheSameMesh) {
    auto mesh = test::make_floor(4.0, 31, test::Winding::mixed);
    test::add_wall(*mesh);
    ShapeLibrary shapes;
    const ShapeId room = shapes.add_mesh(mesh);
    for (const ShapeId body : {shapes.add_box(Vec3::Constant(0.1)), shapes.add_sphere(0.1)}) {
        for (const double depth_m :
             {0.0, 1e-7, 1e-5}) {  // it slides down by as little as a solver's residual
            const auto contacts = contacts_of(
                shapes, {resting(1, room, {}, false),
                         moving(2, body, at({-0.3, 0.1, 0.0}), at({0.9, 0.1 - depth_m, 0.0}))});
            int on_wall = 0;
            for (const ContactPoint& contact : contacts) {
                const bool floor = contact.normal_b_bs.y() > 0.5;
                on_wall += floor ? 0 : 1;
                EXPECT_NEAR(contact.separation_m, floor ? -depth_m : -0.7, 2e-6);
                EXPECT_NEAR(contact.normal_b_bs.x(), floor ? 0.0 : -1.0, 1e-6);
            }
            EXPECT_GE(on_wall, 1);
        }
    }
}

TEST(Sweep, RotatingBoxIsStoppedAtItsCorner) {
    // A bar of half length 0.5 m, 0.3 m above the floor, rotates about its centre by 1.5 rad; its
    // tip sweeps below the floor.
    ShapeLibrary shapes;
    const ShapeId floor = shapes.add_mesh(test::make_floor(4.0, 8));
    const ShapeId bar = shapes.add_box({0.5, 0.02, 0.02});
    const auto contacts =
        contacts_of(shapes, {resting(1, floor, {}, false),
                             moving(2, bar, at({0.0, 0.3, 0.0}),
                                    at({0.0, 0.3, 0.0}, rotation_about(Vec3::UnitZ(), 1.5)))});
    ASSERT_GE(contacts.size(), 2U);
    for (const ContactPoint& contact : contacts) {
        EXPECT_NEAR(contact.normal_b_bs.y(), 1.0, 1e-9);
    }
    // Final height of the tip that touched first (its lower left edge).
    EXPECT_NEAR(test::deepest(contacts), 0.3 - 0.5 * std::sin(1.5) - 0.02 * std::cos(1.5), 1e-6);
}

TEST(Sweep, BodyAtRestOnARotatingFloorIsNotSwept) {
    // Floor and box move and rotate together: relative to the floor nothing moves, however far both
    // go.
    Random random(31);
    ShapeLibrary shapes;
    const ShapeId floor = shapes.add_mesh(test::make_floor(4.0, 8));
    const ShapeId box = shapes.add_box(Vec3::Constant(0.1));
    for (int round = 0; round < 20; ++round) {
        const Pose before = random.pose(100.0);
        const Pose after{before.position + random.vector(20.0), random.rotation()};
        const Pose seat = at({0.4, 0.099, -0.3}, rotation_about(Vec3::UnitY(), 0.5));
        const auto contacts = contacts_of(shapes, {moving(1, floor, before, after, false),
                                                   moving(2, box, before * seat, after * seat)});
        ASSERT_EQ(contacts.size(), 4U);
        for (const ContactPoint& contact : contacts) {
            EXPECT_NEAR(contact.separation_m, -0.001, 1e-9);
        }
    }
}

TEST(Sweep, SweptAndUnsweptMotionsGiveTheSameDepth) {
    // The same motion evaluated at its end and at its first impact: the contact plane is the same,
    // hence the depth too.
    ShapeLibrary shapes;
    const ShapeId floor = shapes.add_mesh(test::make_floor(4.0, 8));
    const ShapeId box = shapes.add_box(Vec3::Constant(0.1));
    const std::vector<ColliderProxy> proxies = {
        resting(1, floor, {}, false),
        moving(2, box, at({0.0, 0.103, 0.0}), at({0.002, 0.097, 0.0}))};
    EXPECT_NEAR(test::deepest(contacts_of(shapes, proxies, {0.02, 0.1})), -0.003, 1e-9);
    EXPECT_NEAR(test::deepest(contacts_of(shapes, proxies, {0.02, 0.001})), -0.003, 1e-9);
}

// Oracle: exact distances at small steps of the motion. Grazing impacts are ignored
// (collision_world.hpp): about one hit of a fast rotating body in a hundred.
TEST(Sweep, TriangleStopsExactlyTheBodiesThatHitIt) {
    Random random(32);
    int hits = 0;
    int misses = 0;
    int grazing = 0;
    for (int round = 0; round < 600; ++round) {
        ShapeLibrary shapes;
        const ShapeId body = round % 3 == 0   ? shapes.add_sphere(0.05)
                             : round % 3 == 1 ? shapes.add_capsule(0.05, 0.2)
                                              : shapes.add_box({0.1, 0.15, 0.05});
        auto mesh = std::make_shared<Mesh>();
        mesh->positions = {random.vector(0.6), random.vector(0.6), random.vector(0.6)};
        mesh->triangles = {{0, 1, 2}};
        const Corners corners{mesh->positions[0], mesh->positions[1], mesh->positions[2]};
        const ShapeId triangle = shapes.add_mesh(mesh);
        const Vec3 start = random.direction();
        const Pose from = at(start, random.rotation());
        // Drawn first: the order of evaluation of arguments is unspecified.
        const Vec3 aside = random.vector(0.3);
        const Pose to = at(aside - start, random.rotation());
        double lowest = 1e9;
        for (int i = 0; i <= 400; ++i) {
            const Pose pose = interpolate(from, to, i / 400.0);
            lowest = std::min(
                lowest,
                test::gap_to_triangle(test::make_core(shapes.at(body), pose), corners).distance_m);
        }
        const auto contacts = contacts_of(
            shapes, {resting(1, triangle, {}, false), moving(2, body, from, to)}, {1e-3, 0.005});
        if (lowest < -0.01) {
            ++hits;
            grazing += contacts.empty() ? 1 : 0;
        } else if (lowest > 0.015) {  // more than a body moves between two steps
            ++misses;
            ASSERT_TRUE(contacts.empty()) << round;
        }
    }
    EXPECT_LE(grazing, hits / 100);
    EXPECT_GT(hits, 150);
    EXPECT_GT(misses, 50);
}

double deepest_m(const std::vector<ContactPoint>& contacts) {
    double deepest = 0.0;
    for (const ContactPoint& contact : contacts) {
        deepest = std::min(deepest, contact.separation_m);
    }
    return deepest;
}

// Oracle: small steps again. At the first step that overlaps any of many triangles, the plane of
// some contact must just be reached; that of a later triangle would still be far. The depth must
// not depend on the triangles' order.
TEST(Sweep, FirstOfManyTrianglesStops) {
    Random random(33);
    constexpr int k_steps = 200;
    constexpr double k_reached_m = 0.03;  // displacement per step, rotation included
    int hits = 0;
    int missed = 0;
    for (int round = 0; round < 80; ++round) {
        ShapeLibrary shapes;
        const ShapeId body =
            round % 2 == 0 ? shapes.add_capsule(0.02, 0.3) : shapes.add_box({0.3, 0.02, 0.05});
        auto mesh = std::make_shared<Mesh>();
        std::vector<Corners> triangles;
        for (std::uint32_t i = 0; i < 24; ++i) {
            const Vec3 middle = random.vector(0.8);
            triangles.push_back({Vec3(middle + random.vector(0.4)),
                                 Vec3(middle + random.vector(0.4)),
                                 Vec3(middle + random.vector(0.4))});
            mesh->positions.insert(mesh->positions.end(), triangles.back().begin(),
                                   triangles.back().end());
            mesh->triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
        }
        const ShapeId soup = shapes.add_mesh(mesh);
        const Vec3 start = 1.5 * random.direction();
        const Pose from = at(start, random.rotation());
        // Drawn first: the order of evaluation of arguments is unspecified.
        const Vec3 aside = random.vector(0.3);
        const Pose to = at(aside - start, random.rotation());
        std::optional<double> met;
        for (int i = 0; i <= k_steps && !met; ++i) {
            const double fraction = static_cast<double>(i) / k_steps;
            const auto core = test::make_core(shapes.at(body), interpolate(from, to, fraction));
            const bool meets = std::ranges::any_of(triangles, [&](const Corners& corners) {
                return test::gap_to_triangle(core, corners).distance_m < -1e-3;
            });
            met = meets ? std::optional(fraction) : std::nullopt;
        }
        if (!met) {
            continue;
        }
        ++hits;
        const auto contacts = contacts_of(
            shapes, {resting(1, soup, {}, false), moving(2, body, from, to)}, {1e-3, 0.005});
        const Pose there = interpolate(from, to, *met);
        const bool reached = std::ranges::any_of(contacts, [&](const ContactPoint& contact) {
            const Vec3 offset = transform_point(there, contact.point_a_bs) - contact.point_b_bs;
            return std::abs(contact.normal_b_bs.dot(offset)) < k_reached_m;
        });
        missed += reached ? 0 : 1;
        std::ranges::reverse(mesh->triangles);
        const ShapeId reversed = shapes.add_mesh(mesh);
        const auto again = contacts_of(
            shapes, {resting(1, reversed, {}, false), moving(2, body, from, to)}, {1e-3, 0.005});
        EXPECT_NEAR(deepest_m(again), deepest_m(contacts), 1e-9);
    }
    EXPECT_GT(hits, 30);
    EXPECT_LE(missed, hits / 50);  // grazing impacts
}

// A body may touch one part of an obstacle, pass it, and end in another part. The solver looks for
// such overlaps in pairs that have a contact.
TEST(Sweep, PairThatOverlapsAtTheEndOfAMotionHasAContact) {
    Random random(61);
    int overlaps = 0;
    for (int round = 0; round < 2000; ++round) {
        ShapeLibrary shapes;
        const ShapeId rod = shapes.add_box({0.02, 0.25, 0.02});
        const auto mesh = std::make_shared<Mesh>();
        for (std::uint32_t box = 0; box < 6; ++box) {
            const auto one = test::make_box_mesh(Vec3::Constant(0.08));
            const Pose place = random.pose(0.4);
            const auto first = static_cast<std::uint32_t>(mesh->positions.size());
            for (const Vec3& position : one->positions) {
                mesh->positions.push_back(transform_point(place, position));
            }
            for (const auto& [a, b, c] : one->triangles) {
                mesh->triangles.push_back({first + a, first + b, first + c});
            }
        }
        const ShapeId clutter = shapes.add_mesh(mesh);
        const Pose from = random.pose(0.6);
        const Pose to{from.position + random.vector(0.4), random.rotation()};
        const ColliderProxy b = resting(1, clutter, {}, false);
        const ColliderProxy a = moving(2, rod, from, to);
        CollisionWorld world(shapes);
        const std::vector<ColliderProxy> proxies = {b, a};
        world.set_proxies(proxies);
        const double overlap_m = world.overlap_m(a, b);
        EXPECT_NEAR(
            overlap_m,
            std::max(0.0, -test::deepest(contacts_of(shapes, {b, resting(2, rod, to, true)}))),
            1e-12);
        std::vector<ContactPoint> contacts;
        world.find_contacts({}, contacts);
        EXPECT_TRUE(overlap_m < 1e-5 || !contacts.empty()) << round << ' ' << overlap_m;
        overlaps += overlap_m > 1e-5 ? 1 : 0;
    }
    EXPECT_GT(overlaps, 150);
}

// Two boxes, one flying into the other while it turns: whatever overlap is left at the end, the
// contacts know its depth. A corner that hangs over the other box's edge counts, because the box
// turns about that edge into the other.
TEST(Sweep, ContactsOfATurningBoxAreAtLeastAsDeepAsTheOverlapAtTheEnd) {
    constexpr double k_tolerance_m = 1e-5;
    Random random(73);
    int overlaps = 0;
    for (int round = 0; round < 1000; ++round) {
        ShapeLibrary shapes;
        const Vec3 half_b{random.between(0.05, 0.2), random.between(0.05, 0.2),
                          random.between(0.05, 0.2)};
        const Vec3 half_a = random.between(0.5, 1.0) * half_b;
        const ShapeId a = shapes.add_box(half_a);
        const ShapeId b = shapes.add_box(half_b);
        const double apart_m = half_a.norm() + half_b.norm() + 0.01;
        const Vec3 from_m = apart_m * random.direction();
        const Pose from = at(from_m, random.rotation());
        const Vec3 axis = random.direction();
        const Quat turn = rotation_about(axis, random.between(0.0, 0.5));
        const Vec3 aside_m = random.vector(0.1);
        const Vec3 to_m = random.between(0.4, 0.8) * from_m + aside_m;
        const ColliderProxy moves = moving(1, a, from, at(to_m, turn * from.rotation));
        const ColliderProxy rests = resting(2, b, {}, true);
        CollisionWorld world(shapes);
        world.set_proxies(std::vector{moves, rests});
        const double overlap_m = world.overlap_m(moves, rests);
        if (overlap_m > 10.0 * k_tolerance_m) {
            std::vector<ContactPoint> contacts;
            world.find_contacts({}, contacts);
            EXPECT_LE(test::deepest(contacts), -overlap_m + k_tolerance_m) << round;
            ++overlaps;
        }
    }
    EXPECT_GT(overlaps, 100);
}

}  // namespace
}  // namespace handhold::collision_sweep_test

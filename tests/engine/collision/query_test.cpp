#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "engine/geometry/closest_point.hpp"
#include "tests/engine/collision/scene.hpp"

namespace handhold::collision_query_test {
namespace {

using test::at;
using test::Random;
using test::resting;

struct World {
    ShapeLibrary shapes;
    std::vector<ColliderProxy> proxies;
    std::unique_ptr<CollisionWorld> world;

    void add(ShapeId shape, const Pose& pose) {
        proxies.push_back(resting(proxies.size() + 1, shape, pose, false));
    }
    CollisionWorld& make() {
        world = std::make_unique<CollisionWorld>(shapes);
        world->set_proxies(proxies);
        return *world;
    }
};

TEST(HashNear, ChangesWithTheEndPosesNearbyAndWithNothingElse) {
    Random random(53);
    for (int round = 0; round < 50; ++round) {
        World w;
        const ShapeId box = w.shapes.add_box({0.2, 0.1, 0.1});
        const ShapeId ball = w.shapes.add_sphere(0.15);
        for (int i = 0; i < 12; ++i) {
            w.add(i % 2 == 0 ? box : ball, {random.vector(1.0), random.rotation()});
        }
        w.add(box, at({9.0, 0.0, 0.0}));
        const CollisionWorld& world = w.make();
        const Vec3 low = random.vector(0.5) - Vec3::Constant(0.3);
        const Vec3 high = low + Vec3::Constant(0.6);
        const std::array<std::uint64_t, 1> skip = {13};
        const auto hash = [&] {
            w.world->set_proxies(w.proxies);
            return world.hash_near(low, high, skip);
        };
        const std::uint64_t first = hash();
        std::vector<ColliderProxy> before = w.proxies;
        for (ColliderProxy& proxy : w.proxies) {
            proxy.from_ws.position += random.vector(2.0);
        }
        EXPECT_EQ(hash(), first);
        w.proxies[12].to_ws = at(low);  // skipped
        EXPECT_EQ(hash(), first);
        w.proxies = before;
        w.proxies[12].to_ws = at({8.0, 0.0, 0.0});
        EXPECT_EQ(hash(), first);
        ColliderProxy& moved = w.proxies[static_cast<std::size_t>(round % 12)];
        moved.to_ws = at(low + random.between(0.0, 0.6) * Vec3::Ones());
        const std::uint64_t entered = hash();
        EXPECT_NE(entered, first);
        moved.to_ws.position.x() += 1e-9;
        EXPECT_NE(hash(), entered);
        moved.to_ws.position.x() = 9.0;
        EXPECT_NE(hash(), entered);
    }
}

TEST(CastRay, HitsEachShapeOnItsExactSurface) {
    Random random(41);
    World w;
    const Vec3 half(0.3, 0.2, 0.4);
    w.add(w.shapes.add_box(half), at({0.0, 0.0, 0.0}, random.rotation()));
    w.add(w.shapes.add_sphere(0.25), at({2.0, 0.0, 0.0}, random.rotation()));
    w.add(w.shapes.add_capsule(0.2, 0.3), at({4.0, 0.0, 0.0}, random.rotation()));
    CollisionWorld& world = w.make();
    for (int round = 0; round < 3000; ++round) {
        const auto index = static_cast<std::size_t>(round % 3);
        const Pose& pose = w.proxies[index].to_ws;
        const Vec3 from = pose.position + 0.9 * random.direction();
        const Vec3 to = pose.position + random.vector(0.5);
        const auto hit = world.cast_ray(from, to);
        // Oracle: signed distance of a point to the surface, in the shape's own frame.
        const auto surface_gap = [&](const Vec3& point_ws) {
            const Vec3 p = inverse_transform_point(pose, point_ws);
            if (index == 0) {
                return (p.cwiseAbs() - half).maxCoeff();
            }
            const Vec3 axis(0.0, index == 1 ? 0.0 : std::clamp(p.y(), -0.3, 0.3), 0.0);
            return (p - axis).norm() - (index == 1 ? 0.25 : 0.2);
        };
        double inside = 1.0;
        const double end = hit ? hit->distance_m / (to - from).norm() : 1.0;
        for (int i = 0; i < 100; ++i) {
            inside = std::min(inside, surface_gap(from + end * i / 100.0 * (to - from)));
        }
        ASSERT_GT(inside, 0.0) << "passed through the surface";
        if (hit) {
            ASSERT_EQ(hit->id, index + 1);
            ASSERT_NEAR(surface_gap(hit->point_ws), 0.0, 1e-12);
            ASSERT_LT(hit->normal_ws.dot(to - from), 0.0);
            ASSERT_NEAR(hit->normal_ws.norm(), 1.0, 1e-12);
            ASSERT_GT(surface_gap(hit->point_ws + 1e-4 * hit->normal_ws), 0.9e-4);
        }
    }
}

TEST(CastRay, FromInsideHitsTheExit) {
    World w;
    w.add(w.shapes.add_box({0.5, 0.5, 0.5}), {});
    w.add(w.shapes.add_sphere(0.5), at({3.0, 0.0, 0.0}));
    CollisionWorld& world = w.make();
    for (const double x : {0.0, 3.0}) {
        const auto hit = world.cast_ray({x, 0.0, 0.0}, {x, 1.0, 0.0});
        ASSERT_TRUE(hit);
        EXPECT_NEAR(hit->distance_m, 0.5, 1e-12);
        EXPECT_NEAR(hit->normal_ws.y(), -1.0, 1e-12);  // towards the side the ray came from
    }
}

TEST(CastRay, HitsBothSidesOfTriangles) {
    World w;
    w.add(w.shapes.add_mesh(test::make_floor(4.0, 7, test::Winding::mixed)), {});
    CollisionWorld& world = w.make();
    Random random(42);
    for (int round = 0; round < 500; ++round) {
        const double side = round % 2 == 0 ? 1.0 : -1.0;
        const Vec3 through{random.between(-1.9, 1.9), 0.0, random.between(-1.9, 1.9)};
        const Vec3 from =
            through + Vec3{random.between(-1.0, 1.0), side, random.between(-1.0, 1.0)};
        const auto hit = world.cast_ray(from, 2.0 * through - from);
        ASSERT_TRUE(hit);
        EXPECT_NEAR((hit->point_ws - through).norm(), 0.0, 1e-12);
        EXPECT_NEAR(hit->normal_ws.y(), side, 1e-12);
    }
}

TEST(CastRay, DoesNotPassBetweenNeighbouringTriangles) {
    World w;
    w.add(w.shapes.add_mesh(test::make_floor(4.0, 8)), {});
    CollisionWorld& world = w.make();
    for (int x = -7; x <= 7; ++x) {  // every vertex and edge except the rim
        for (int z = -7; z <= 7; ++z) {
            const Vec3 point(0.25 * x, 0.0, 0.25 * z);
            EXPECT_TRUE(world.cast_ray(point + Vec3::UnitY(), point - Vec3::UnitY()));
            EXPECT_TRUE(world.cast_ray(point + Vec3(0.3, 1.0, 0.1), point - Vec3(0.3, 1.0, 0.1)));
        }
    }
}

TEST(CastRay, ReturnsTheFirstHitThatIsNotSkippedWithinItsLength) {
    World w;
    const ShapeId ball = w.shapes.add_sphere(0.1);
    for (int i = 1; i <= 3; ++i) {
        w.add(ball, at({static_cast<double>(i), 0.0, 0.0}));
    }
    CollisionWorld& world = w.make();
    EXPECT_EQ(world.cast_ray(Vec3::Zero(), {5.0, 0.0, 0.0})->id, 1U);
    const std::array<std::uint64_t, 2> skip = {1, 2};
    EXPECT_EQ(world.cast_ray(Vec3::Zero(), {5.0, 0.0, 0.0}, skip)->id, 3U);
    EXPECT_FALSE(world.cast_ray(Vec3::Zero(), {0.89, 0.0, 0.0}));
    EXPECT_FALSE(world.cast_ray(Vec3::Zero(), Vec3::Zero()));
}

TEST(CastRay, OnAMeshAgreesWithBruteForce) {
    World w;
    const auto mesh = test::make_wavy_ball(1.0, 40, 60);
    const Pose pose = at({3.0, -2.0, 1.0}, rotation_from_vector({0.4, -0.9, 0.3}));
    w.add(w.shapes.add_mesh(mesh), pose);
    CollisionWorld& world = w.make();
    Random random(43);
    for (int round = 0; round < 300; ++round) {
        const Vec3 from = pose.position + 3.0 * random.direction();
        const Vec3 to = pose.position + random.vector(1.2);
        const auto hit = world.cast_ray(from, to);
        // Oracle: signed volumes of the segment with each triangle's edges.
        const Vec3 p = inverse_transform_point(pose, from);
        const Vec3 q = inverse_transform_point(pose, to);
        double nearest = 2.0;
        for (const auto& t : mesh->triangles) {
            const Vec3 a = mesh->positions[t[0]] - p;
            const Vec3 b = mesh->positions[t[1]] - p;
            const Vec3 c = mesh->positions[t[2]] - p;
            const Vec3 d = q - p;
            const double u = d.dot(b.cross(c));
            const double v = d.dot(c.cross(a));
            const double s = d.dot(a.cross(b));
            if ((u >= 0.0 && v >= 0.0 && s >= 0.0) || (u <= 0.0 && v <= 0.0 && s <= 0.0)) {
                const double sum = u + v + s;
                if (sum != 0.0) {
                    const double fraction = (u * a + v * b + s * c).dot(d) / sum / d.squaredNorm();
                    nearest = fraction >= 0.0 ? std::min(nearest, fraction) : nearest;
                }
            }
        }
        ASSERT_EQ(hit.has_value(), nearest <= 1.0) << round;
        if (hit) {
            ASSERT_NEAR(hit->distance_m, nearest * (q - p).norm(), 1e-9);
        }
    }
}

TEST(CastSphere, StopsARadiusBeforeAPlane) {
    World w;
    w.add(w.shapes.add_mesh(test::make_floor(4.0, 9)), {});
    w.add(w.shapes.add_box({0.5, 0.5, 0.5}), at({10.0, -0.5, 0.0}));
    CollisionWorld& world = w.make();
    for (const double x : {0.1, 10.1}) {
        const Vec3 from(x, 1.0, 0.2);
        const Vec3 to(x + 0.1, -1.0, 0.1);
        const auto hit = world.cast_sphere(0.2, from, to);
        ASSERT_TRUE(hit);
        EXPECT_NEAR(hit->distance_m, 0.4 * (to - from).norm(),
                    2e-6);  // the centre descends 2 m in all and stops after 0.8 m
        EXPECT_NEAR(hit->normal_ws.y(), 1.0, 1e-9);
        EXPECT_NEAR(hit->point_ws.y(), 0.0, 1e-12);
    }
}

TEST(CastSphere, OnAMeshMatchesTheNearestOfItsTriangles) {
    Random random(47);
    int hits = 0;
    for (int round = 0; round < 20; ++round) {
        const Vec3 scale = Vec3::Constant(1.0) + random.vector(0.6);
        World all;
        std::vector<World> single(40);
        auto mesh = std::make_shared<Mesh>();
        const Pose pose{random.vector(3.0), round % 2 == 0 ? Quat::Identity() : random.rotation()};
        for (World& one : single) {
            auto triangle = std::make_shared<Mesh>();
            const Vec3 centre = random.vector(1.0);
            const double size_m = random.between(0.05, 0.8);
            for (std::uint32_t corner = 0; corner < 3; ++corner) {
                triangle->positions.emplace_back(centre + size_m * random.direction());
            }
            triangle->triangles.push_back({0, 1, 2});
            const auto first = static_cast<std::uint32_t>(mesh->positions.size());
            mesh->positions.insert(mesh->positions.end(), triangle->positions.begin(),
                                   triangle->positions.end());
            mesh->triangles.push_back({first, first + 1, first + 2});
            one.add(one.shapes.add_mesh(triangle, scale), pose);
            one.make();
        }
        all.add(all.shapes.add_mesh(mesh, scale), pose);
        const CollisionWorld& world = all.make();
        for (int cast = 0; cast < 30; ++cast) {
            const double radius_m = random.between(0.01, 0.2);
            const Vec3 from = transform_point(pose, random.vector(1.5));
            Vec3 to = transform_point(pose, random.vector(1.5));
            if (cast % 3 == 0) {
                to = from + Vec3::Unit(cast % 9 / 3) * random.between(-2.0, 2.0);
            }
            double nearest_m = 1e9;
            for (const World& one : single) {
                const auto hit = one.world->cast_sphere(radius_m, from, to);
                nearest_m = std::min(nearest_m, hit ? hit->distance_m : 1e9);
            }
            const auto hit = world.cast_sphere(radius_m, from, to);
            ASSERT_EQ(hit ? hit->distance_m : 1e9, nearest_m) << round << ' ' << cast;
            hits += hit && hit->distance_m > 0.0 ? 1 : 0;
        }
    }
    EXPECT_GT(hits, 150);
}

TEST(CastSphere, HitsAtZeroIfItStartsInTouchAndMissesInPassing) {
    World w;
    const ShapeId ball = w.shapes.add_sphere(0.5);
    w.add(ball, {});
    CollisionWorld& world = w.make();
    EXPECT_EQ(world.cast_sphere(0.2, {0.6, 0.0, 0.0}, {5.0, 0.0, 0.0})->distance_m, 0.0);
    EXPECT_FALSE(world.cast_sphere(0.2, {-2.0, 0.701, 0.0}, {2.0, 0.701, 0.0}));
    const auto grazing = world.cast_sphere(0.2, {-2.0, 0.6, 0.0}, {2.0, 0.6, 0.0});
    ASSERT_TRUE(grazing);
    EXPECT_NEAR(grazing->distance_m, 2.0 - std::sqrt(0.49 - 0.36), 1e-5);
    const std::array<std::uint64_t, 1> skip = {1};
    EXPECT_FALSE(world.cast_sphere(0.2, {-2.0, 0.0, 0.0}, {2.0, 0.0, 0.0}, skip));
}

TEST(ClosestPointQuery, OnConvexShapesMatchesTheClosedForm) {
    World w;
    w.add(w.shapes.add_box({0.3, 0.2, 0.4}), at({0.0, 0.0, 0.0}));
    w.add(w.shapes.add_sphere(0.25), at({5.0, 0.0, 0.0}));
    w.add(w.shapes.add_capsule(0.2, 0.3), at({10.0, 0.0, 0.0}));
    CollisionWorld& world = w.make();
    EXPECT_NEAR(world.closest_point({0.6, 0.6, 0.0}, 2.0)->distance_m, 0.5,
                1e-12);  // 3-4-5 to the edge
    EXPECT_NEAR(world.closest_point({5.0, 1.0, 0.0}, 2.0)->distance_m, 0.75, 1e-12);
    EXPECT_NEAR(world.closest_point({10.0, 1.0, 0.0}, 2.0)->distance_m, 0.5, 1e-12);
    EXPECT_NEAR(world.closest_point({11.0, 0.1, 0.0}, 2.0)->distance_m, 0.8, 1e-12);
    const auto inside = world.closest_point({0.0, 0.15, 0.0}, 2.0);
    EXPECT_EQ(inside->distance_m, 0.0);
    EXPECT_NEAR((inside->point_ws - Vec3(0.0, 0.2, 0.0)).norm(), 0.0, 1e-12);
    EXPECT_NEAR(inside->normal_ws.y(), 1.0, 1e-12);
    EXPECT_FALSE(world.closest_point({2.5, 0.0, 0.0}, 1.0));
}

TEST(ClosestPointQuery, OnAMeshAgreesWithBruteForce) {
    World w;
    const auto mesh = test::make_wavy_ball(1.0, 30, 50);
    const Pose pose = at({300.0, -2.0, 1.0}, rotation_from_vector({0.4, -0.9, 0.3}));
    w.add(w.shapes.add_mesh(mesh), pose);
    CollisionWorld& world = w.make();
    Random random(44);
    for (int round = 0; round < 200; ++round) {
        const Vec3 point = pose.position + random.vector(2.0);
        const Vec3 local = inverse_transform_point(pose, point);
        double nearest = 1e9;
        for (const auto& t : mesh->triangles) {
            const Corners corners{mesh->positions[t[0]], mesh->positions[t[1]],
                                  mesh->positions[t[2]]};
            nearest = std::min(nearest, (closest_on_triangle(local, corners) - local).norm());
        }
        const double limit = random.between(0.05, 4.0);
        const auto found = world.closest_point(point, limit);
        ASSERT_EQ(found.has_value(), nearest <= limit);
        if (found) {
            ASSERT_NEAR(found->distance_m, nearest, 1e-11);
            ASSERT_NEAR((point - found->point_ws - found->distance_m * found->normal_ws).norm(),
                        0.0, 1e-11);
        }
    }
}

TEST(ClosestPointQuery, PointOnTheSurfaceHasTheTrianglesNormal) {
    World w;
    w.add(w.shapes.add_mesh(test::make_floor(4.0, 7)), at({0.0, 5.0, 0.0}));
    const auto found = w.make().closest_point({0.3, 5.0, 0.2}, 1.0);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->distance_m, 0.0);
    EXPECT_NEAR(found->normal_ws.y(), 1.0, 1e-12);
}

// Oracle: closest_point with all other colliders skipped.
TEST(ClosestPointOn, EqualsClosestPointWithAllOthersSkipped) {
    World all;
    const std::vector<std::pair<ShapeId, Pose>> bodies = {
        {all.shapes.add_sphere(0.3), at({2.0, 0.0, 0.0})},
        {all.shapes.add_box({0.4, 0.1, 0.2}), at({-1.0, 0.5, 0.0})},
        {all.shapes.add_mesh(test::make_floor(4.0, 7, test::Winding::mixed)),
         at({0.0, -2.0, 0.0})}};
    for (const auto& [shape, pose] : bodies) {
        all.add(shape, pose);
    }
    CollisionWorld& world = all.make();
    const Vec3 point(0.1, 0.2, 0.3);
    for (std::uint64_t id = 1; id <= bodies.size(); ++id) {
        std::vector<std::uint64_t> others = {1, 2, 3};
        std::erase(others, id);
        const auto near = world.closest_point_on(id, point);
        const auto expected = world.closest_point(point, 100.0, others);
        ASSERT_TRUE(near && expected) << id;
        EXPECT_EQ(near->id, id);
        EXPECT_LT((near->point_ws - expected->point_ws).norm(), 1e-12);
        EXPECT_NEAR(near->distance_m, expected->distance_m, 1e-12);
    }
    EXPECT_FALSE(world.closest_point_on(99, point));
}

}  // namespace
}  // namespace handhold::collision_query_test

#include <array>

#include <gtest/gtest.h>

#include "tests/engine/allocation_count.hpp"
#include "tests/engine/collision/scene.hpp"

namespace handhold::collision_allocation_test {
namespace {

using test::at;
using test::Random;

TEST(CollisionWorld, WarmWorldAllocatesNothing) {
    (void)collision_allocation_count();  // hooks Bullet's allocator
    ShapeLibrary shapes;
    const ShapeId ball = shapes.add_sphere(0.12);
    const std::vector<CompoundChild> pair = {{ball, at({-0.1, 0.0, 0.0}), 0.0},
                                             {ball, at({0.1, 0.0, 0.0}), 0.0}};
    Random corner(1);
    std::vector<Vec3> corners(30);
    for (Vec3& point : corners) {
        point = corner.vector(0.15);
    }
    const std::array<ShapeId, 6> kinds = {shapes.add_box({0.1, 0.05, 0.2}),
                                          ball,
                                          shapes.add_capsule(0.06, 0.15),
                                          shapes.add_cylinder(0.1, 0.08),
                                          shapes.add_centred(shapes.add_hull(corners)).shape,
                                          shapes.add_compound(pair)};
    const ShapeId level = shapes.add_mesh(test::make_wavy_ball(1.2, 24, 40));
    CollisionWorld world(shapes);
    std::vector<ColliderProxy> proxies;
    std::vector<ContactPoint> contacts;
    std::size_t most_contacts = 0;
    // Bodies move back and forth, and each is absent in some rounds. The second 110 rounds repeat
    // the first.
    const auto round_trip = [&](int round) {
        proxies.clear();
        proxies.push_back({1, level, {}, {}, false});
        for (std::uint64_t id = 2; id < 40; ++id) {
            if ((static_cast<int>(id) + round) % 11 == 0) {
                continue;
            }
            Random random(id);
            const Vec3 start = 1.05 * random.direction();
            const Vec3 velocity = random.vector(0.02);
            const Quat rotation = random.rotation();
            proxies.push_back({id, kinds[id % 6], at(start + (round % 10) * velocity, rotation),
                               at(start + (round % 10 + 1) * velocity, rotation), true});
        }
        world.set_proxies(proxies);
        world.find_contacts({}, contacts);
        most_contacts = std::max(most_contacts, contacts.size());
        for (int i = 0; i < 4; ++i) {
            (void)world.cast_ray({0.0, 0.1 * i, 0.0}, {2.0, 0.3, 0.1 * round});
            (void)world.cast_sphere(0.05, {0.0, 0.1 * i, 0.0}, {2.0, 0.3, 0.1});
            (void)world.closest_point({0.2 * i, 0.1, 0.0}, 2.0);
        }
    };
    for (int round = 0; round < 110; ++round) {
        round_trip(round);
    }
    const std::size_t allocations = allocation_count();
    const std::uint64_t library_allocations = collision_allocation_count();
    EXPECT_GT(library_allocations, 0U);  // the hook works
    for (int round = 110; round < 220; ++round) {
        round_trip(round);
    }
    EXPECT_EQ(allocation_count() - allocations, 0U);
    EXPECT_EQ(collision_allocation_count() - library_allocations, 0U);
    EXPECT_GT(most_contacts, 50U);
}

// Ids stay, but bodies drift: forty small boxes approach a large one until its list of neighbours
// holds them all. None comes near enough for a contact.
TEST(CollisionWorld, WarmWorldWithNewNeighboursAllocatesNothing) {
    (void)collision_allocation_count();
    ShapeLibrary shapes;
    const ShapeId large = shapes.add_box(Vec3::Constant(0.5));
    const ShapeId small = shapes.add_box(Vec3::Constant(0.02));
    CollisionWorld world(shapes);
    std::vector<ColliderProxy> proxies = {{1, large, {}, {}, true}};
    std::vector<Vec3> ends = {Vec3::Zero()};
    for (int i = 0; i < 40; ++i) {
        ends.emplace_back(0.15 * (i % 7 - 3), 0.62, 0.15 * (i / 7 - 3));
        proxies.push_back({proxies.size() + 1, small, {}, {}, true});
    }
    std::vector<ContactPoint> contacts;
    const auto frame = [&](double height_m) {
        for (std::size_t i = 0; i < proxies.size(); ++i) {
            proxies[i].from_ws = proxies[i].to_ws;
            proxies[i].to_ws = at(ends[i] + (i > 0 ? height_m : 0.0) * Vec3::UnitY());
        }
        world.update_proxies(proxies);
        world.find_contacts({}, contacts);
    };
    for (std::size_t i = 0; i < proxies.size(); ++i) {
        proxies[i].to_ws = at({static_cast<double>(i), 3.0, 0.0});
        proxies[i].from_ws = proxies[i].to_ws;
    }
    world.set_proxies(proxies);
    for (int i = 0; i < 20; ++i) {
        frame(0.2 + 0.001 * (i % 2));
    }
    const std::size_t allocations = allocation_count();
    const std::uint64_t library_allocations = collision_allocation_count();
    for (int i = 0; i <= 100; ++i) {
        frame(0.002 * (100 - i));
    }
    EXPECT_EQ(allocation_count() - allocations, 0U);
    EXPECT_EQ(collision_allocation_count() - library_allocations, 0U);
}

}  // namespace
}  // namespace handhold::collision_allocation_test

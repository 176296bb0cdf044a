// The broadphase's tree stays shallow however many colliders leave and return.
#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "engine/collision/collision_world.hpp"
#include "tests/random.hpp"

namespace handhold::collision_broadphase_test {
namespace {

using test::Random;

std::vector<ColliderProxy> scattered(std::size_t count, Random& random) {
    std::vector<ColliderProxy> proxies(count);
    for (std::size_t i = 0; i < count; ++i) {
        proxies[i].id = i + 1;
        proxies[i].shape = {0};
        proxies[i].from_ws = proxies[i].to_ws = random.pose(20.0);
        proxies[i].free = true;
    }
    return proxies;
}

// Removing a collider costs a path of the tree. Unused leaves once formed a list, so that removing
// n colliders cost n^2.
TEST(Broadphase, TreeStaysShallowWhenManyCollidersLeaveAndReturn) {
    constexpr std::size_t k_colliders = 4000;
    constexpr int k_max_depth = 120;
    Random random(3);
    ShapeLibrary shapes;
    shapes.add_sphere(0.1);
    CollisionWorld world(shapes);
    for (int round = 0; round < 3; ++round) {
        const std::vector<ColliderProxy> proxies = scattered(k_colliders, random);
        world.set_proxies(proxies);
        EXPECT_LT(world.broadphase_depth(), k_max_depth);
        world.set_proxies(std::span(proxies).first(3));
        EXPECT_LT(world.broadphase_depth(), k_max_depth);
        const Vec3& centre_ws = proxies[1].to_ws.position;
        const auto hit = world.closest_point(centre_ws, 0.05);
        ASSERT_TRUE(hit.has_value());
        EXPECT_EQ(hit->id, 2U);
        EXPECT_FALSE(world.closest_point(proxies[100].to_ws.position, 0.05).has_value());
    }
}

// A spawn outdates all lists of neighbours. Renewing them costs queries for free bodies alone.
TEST(Broadphase, SpawnAmongManyFixedCollidersCostsFewQueries) {
    Random random(11);
    ShapeLibrary shapes;
    shapes.add_sphere(0.1);
    CollisionWorld world(shapes);
    std::vector<ColliderProxy> proxies = scattered(2000, random);
    for (ColliderProxy& proxy : proxies) {
        proxy.free = false;
    }
    std::vector<ContactPoint> contacts;
    for (std::uint64_t spawned = 1; spawned <= 20; ++spawned) {
        ColliderProxy projectile = proxies.back();
        projectile.id = proxies.back().id + 1;
        projectile.to_ws = projectile.from_ws = random.pose(20.0);
        projectile.free = true;
        proxies.push_back(projectile);
        world.set_proxies(proxies);
        world.find_contacts({}, contacts);
        (void)world.take_work();
        proxies.back().to_ws.position.y() += 0.05;
        world.update_proxies(std::span(proxies).last(1));
        world.find_contacts({}, contacts);
        const std::uint64_t queries = world.take_work().tree_queries;
        EXPECT_GE(queries, spawned);  // one per free body
        EXPECT_LE(queries, 3 * spawned + 3);
    }
}

bool same_contact(const ContactPoint& x, const ContactPoint& y) {
    return x.id_a == y.id_a && x.id_b == y.id_b && x.feature == y.feature &&
           x.point_a_bs == y.point_a_bs && x.point_b_bs == y.point_b_bs &&
           x.normal_b_bs == y.normal_b_bs && x.separation_m == y.separation_m;
}

// Leaves have slack and keep lists of their neighbours. Boxes drift within and out of their leaves,
// some jump, some become fixed and free again, some have no valid pose for a while.
TEST(Broadphase, DriftingBodiesHaveTheContactsOfANewWorld) {
    Random random(7);
    ShapeLibrary shapes;
    shapes.add_box({0.1, 0.08, 0.12});
    shapes.add_sphere(0.15);
    CollisionWorld world(shapes);
    std::vector<ColliderProxy> proxies = scattered(120, random);
    std::vector<Vec3> velocities;
    for (ColliderProxy& proxy : proxies) {
        proxy.shape = {proxy.id % 5 == 0 ? 1U : 0U};
        proxy.to_ws.position *= 0.04;  // within 1.6 m
        proxy.from_ws = proxy.to_ws;
        velocities.push_back(random.vector(0.01));
    }
    world.set_proxies(proxies);
    std::size_t total = 0;
    std::vector<ContactPoint> warm;
    std::vector<ContactPoint> fresh;
    for (int frame = 0; frame < 150; ++frame) {
        std::vector<ColliderProxy> changed;
        for (std::size_t i = 0; i < proxies.size(); ++i) {
            ColliderProxy& proxy = proxies[i];
            const double chance = random.between(0.0, 1.0);
            proxy.from_ws = proxy.to_ws;
            proxy.to_ws.position += chance < 0.005 ? random.vector(1.0) : velocities[i];
            if (chance > 0.99) {
                proxy.free = !proxy.free;
            }
            if (chance > 0.4) {
                changed.push_back(proxy);
                if (chance > 0.95) {
                    changed.back().to_ws.position.x() = std::nan("");
                }
            } else {
                proxy.to_ws = proxy.from_ws;
            }
        }
        const auto compare = [&] {
            CollisionWorld other(shapes);
            other.set_proxies(proxies);
            world.find_contacts({}, warm);
            other.find_contacts({}, fresh);
            total += warm.size();
            return std::ranges::equal(warm, fresh, same_contact);
        };
        world.update_proxies(changed);
        world.find_contacts({}, warm);  // with the invalid poses
        for (const ColliderProxy& proxy : proxies) {
            world.update_proxies(std::span(&proxy, 1));
        }
        ASSERT_TRUE(compare()) << frame;
    }
    EXPECT_GT(total, 5000U);
}

}  // namespace
}  // namespace handhold::collision_broadphase_test

// The broadphase's tree stays shallow however many colliders leave and return.
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

}  // namespace
}  // namespace handhold::collision_broadphase_test

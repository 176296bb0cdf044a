// The tree over moving bounds stays shallow whatever comes and goes.
#include <vector>

#include <gtest/gtest.h>

#include "engine/collision/bullet_broadphase.hpp"
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

// One cost is a path in the tree: n bodies that leave at once cost n paths. Parked leaves used to
// form a list, as deep as there are leaves.
TEST(Broadphase, TreeStaysShallowWhenManyBodiesLeaveAndReturn) {
    constexpr std::size_t k_bodies = 4000;
    constexpr int k_deepest = 120;
    Random random(3);
    ShapeLibrary shapes;
    const std::vector<ShapeExtent> extents = {shape_extent(shapes.at(shapes.add_sphere(0.1)))};
    Broadphase broadphase;
    for (int round = 0; round < 3; ++round) {
        const std::vector<ColliderProxy> proxies = scattered(k_bodies, random);
        broadphase.set_proxies(proxies, extents);
        EXPECT_LT(broadphase.depth(), k_deepest);
        broadphase.set_proxies(std::span(proxies).first(3), extents);
        EXPECT_LT(broadphase.depth(), k_deepest);
        BroadphaseScratch scratch;
        const Bounds everywhere{Vec3::Constant(-1e6), Vec3::Constant(1e6)};
        EXPECT_EQ(broadphase.find(everywhere, scratch).size(), 3U);
    }
}

}  // namespace
}  // namespace handhold::collision_broadphase_test

#include <array>
#include <atomic>
#include <cstdlib>

#include <gtest/gtest.h>

#include "engine/collision/collision_world.hpp"

// Of Bullet, LinearMath/btAlignedAllocator.h: tests have not its include path.
void btAlignedAllocSetCustom(void* (*allocate)(std::size_t), void (*release)(void*));
void* btAlignedAllocInternal(std::size_t size, int alignment);
void btAlignedFreeInternal(void* memory);

namespace handhold::host_allocator_test {
namespace {

std::atomic<int> g_taken{0};
std::atomic<int> g_given_back{0};

void* take(std::size_t size) {
    ++g_taken;
    return std::malloc(size);
}
void give_back(void* memory) {
    g_given_back += memory != nullptr ? 1 : 0;
    std::free(memory);
}

// A host that uses Bullet with its own allocator keeps it: else its blocks would go to another
// heap.
TEST(CollisionWorld, LeavesBulletsAllocatorToTheHost) {
    btAlignedAllocSetCustom(&take, &give_back);
    {
        ShapeLibrary shapes;
        const ShapeId ball = shapes.add_sphere(0.2);
        CollisionWorld world(shapes);
        const std::array proxies = {ColliderProxy{1, ball, {}, {}, true}};
        world.set_proxies(proxies);
    }
    const int before = g_taken;
    void* const hosts = btAlignedAllocInternal(100, 16);
    EXPECT_EQ(g_taken, before + 1);
    btAlignedFreeInternal(hosts);
    EXPECT_EQ(g_taken, g_given_back) << "all of the world's blocks came back";
    btAlignedAllocSetCustom(nullptr, nullptr);
}

}  // namespace
}  // namespace handhold::host_allocator_test

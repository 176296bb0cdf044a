#include "engine/ecs/entity.hpp"

#include <cstdint>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "engine/core/check.hpp"

namespace handhold::entity_test {
namespace {

TEST(EntityPool, NullIsNeverAliveOrDestroyed) {
    EntityPool pool;
    pool.create();
    EXPECT_TRUE(is_null(Entity{}));
    EXPECT_FALSE(pool.is_alive(k_no_entity));
    EXPECT_FALSE(pool.destroy(k_no_entity));
    EXPECT_EQ(pool.alive_count(), 1U);
}

TEST(EntityPool, UnknownSlotIsNotAlive) {
    const EntityPool pool;
    EXPECT_FALSE(pool.is_alive({7, 1}));
}

TEST(EntityPool, DestroyedHandleStaysStaleAfterSlotReuse) {
    EntityPool pool;
    const Entity old = pool.create();
    EXPECT_TRUE(pool.destroy(old));
    EXPECT_FALSE(pool.is_alive(old));
    const Entity next = pool.create();
    EXPECT_EQ(next.slot, old.slot);
    EXPECT_NE(next, old);
    EXPECT_FALSE(pool.is_alive(old));
    EXPECT_TRUE(pool.is_alive(next));
}

TEST(EntityPool, SecondDestroyChangesNothing) {
    EntityPool pool;
    const Entity entity = pool.create();
    pool.create();
    EXPECT_TRUE(pool.destroy(entity));
    EXPECT_FALSE(pool.destroy(entity));
    EXPECT_EQ(pool.alive_count(), 1U);
    EXPECT_NE(pool.create(), pool.create()) << "a slot freed twice would be given out twice";
}

TEST(EntityPool, StaleHandleDoesNotDestroyNextEntityInSlot) {
    EntityPool pool;
    const Entity old = pool.create();
    pool.destroy(old);
    const Entity next = pool.create();
    EXPECT_FALSE(pool.destroy(old));
    EXPECT_TRUE(pool.is_alive(next));
}

TEST(EntityPool, ReusesFreedSlotsLastFirst) {
    EntityPool pool;
    const Entity a = pool.create();
    const Entity b = pool.create();
    pool.destroy(a);
    pool.destroy(b);
    EXPECT_EQ(pool.create().slot, b.slot);
    EXPECT_EQ(pool.create().slot, a.slot);
    EXPECT_EQ(pool.create().slot, 2U);
}

TEST(EntityPool, GenerationSkipsNullWhenItWrapsAround) {
    constexpr std::uint32_t k_last = std::numeric_limits<std::uint32_t>::max();
    EntityPool pool({k_last}, {});
    const Entity last = {0, k_last};
    EXPECT_TRUE(pool.is_alive(last));
    pool.destroy(last);
    const Entity wrapped = pool.create();
    EXPECT_EQ(wrapped, (Entity{0, 1}));
    EXPECT_FALSE(is_null(wrapped));
    EXPECT_FALSE(pool.is_alive(last));
}

TEST(EntityPool, RestoredPoolCreatesSameEntities) {
    EntityPool pool;
    std::vector<Entity> entities;
    for (int i = 0; i < 10; ++i) {
        entities.push_back(pool.create());
    }
    for (const std::size_t i : {3U, 8U, 1U}) {
        pool.destroy(entities[i]);
    }
    EntityPool restored(pool.generations(), pool.free_slots());
    EXPECT_EQ(restored.alive_count(), 7U);
    for (const Entity entity : entities) {
        EXPECT_EQ(restored.is_alive(entity), pool.is_alive(entity));
    }
    for (int i = 0; i < 5; ++i) {
        EXPECT_EQ(restored.create(), pool.create());
    }
}

TEST(EntityPool, RejectsInvalidSnapshot) {
    EXPECT_THROW(EntityPool({1, 1}, {2}), PreconditionError);
    EXPECT_THROW(EntityPool({1, 1}, {1, 1}), PreconditionError);
    EXPECT_THROW(EntityPool({1, 0}, {}), PreconditionError);
    EXPECT_NO_THROW(EntityPool({1, 0}, {1}));
}

}  // namespace
}  // namespace handhold::entity_test

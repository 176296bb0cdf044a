#include "engine/ecs/join.hpp"

#include <algorithm>
#include <cstdint>
#include <random>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace handhold::join_test {
namespace {

using Visited =
    std::vector<std::tuple<std::uint32_t, int, int>>;  // slot, the driver's value, the other's

std::vector<Entity> make_entities(EntityPool& pool, std::size_t count) {
    std::vector<Entity> entities(count);
    std::generate(entities.begin(), entities.end(), [&] { return pool.create(); });
    return entities;
}

// A column with values of `factor` times the slot, filled in the given order.
Column<int> column_of(const std::vector<Entity>& entities, int factor) {
    Column<int> column;
    for (const Entity entity : entities) {
        column.add(entity, factor * static_cast<int>(entity.slot));
    }
    return column;
}

Visited visit_all(const Column<int>& driver, const Column<int>& other) {
    Visited visited;
    join(
        driver, [&](Entity entity, int a, int b) { visited.emplace_back(entity.slot, a, b); },
        other);
    return visited;
}

// Definition of a join: look up each of the driver's rows.
Visited visit_all_one_by_one(const Column<int>& driver, const Column<int>& other) {
    Visited visited;
    for (const Entity entity : driver.owners()) {
        if (const int* const found = other.find(entity)) {
            visited.emplace_back(entity.slot, driver.at(entity), *found);
        }
    }
    return visited;
}

TEST(Join, EmptyColumnsVisitNothing) {
    EntityPool pool;
    const Column<int> some = column_of(make_entities(pool, 3), 1);
    const Column<int> none;
    EXPECT_TRUE(visit_all(none, some).empty());
    EXPECT_TRUE(visit_all(some, none).empty());
    EXPECT_TRUE(visit_all(none, none).empty());
}

TEST(Join, DriverAloneVisitsEveryElement) {
    EntityPool pool;
    Column<int> driver = column_of(make_entities(pool, 300), 1);
    int visits = 0;
    join(driver, [&](Entity entity, int& value) {
        EXPECT_EQ(value, static_cast<int>(entity.slot));
        ++visits;
    });
    EXPECT_EQ(visits, 300);
}

TEST(Join, WritesThroughMutableColumnsAndReadsConstOnes) {
    EntityPool pool;
    const std::vector<Entity> entities = make_entities(pool, 1000);
    Column<int> sums = column_of(entities, 0);
    const Column<int> a = column_of(entities, 2);
    Column<int> b = column_of(entities, 3);
    join(
        sums,
        [](Entity, int& sum, const int& left, int& right) {
            sum = left + right;
            right = -1;
        },
        a, b);
    for (const Entity entity : entities) {
        EXPECT_EQ(sums.at(entity), 5 * static_cast<int>(entity.slot));
        EXPECT_EQ(b.at(entity), -1);
    }
}

TEST(Join, PartialOverlapVisitsIntersectionInDriverOrder) {
    EntityPool pool;
    const std::vector<Entity> entities = make_entities(pool, 1000);
    const Column<int> driver = column_of({entities.begin(), entities.begin() + 700}, 1);
    const Column<int> other = column_of({entities.begin() + 300, entities.end()}, 10);
    const Visited visited = visit_all(driver, other);
    ASSERT_EQ(visited.size(), 400U);
    for (std::size_t i = 0; i < visited.size(); ++i) {
        const int slot = 300 + static_cast<int>(i);
        EXPECT_EQ(visited[i], std::make_tuple(static_cast<std::uint32_t>(slot), slot, 10 * slot));
    }
}

TEST(Join, ThirdColumnNarrowsIntersection) {
    EntityPool pool;
    const std::vector<Entity> entities = make_entities(pool, 600);
    const Column<int> all = column_of(entities, 1);
    const Column<int> lower = column_of({entities.begin(), entities.begin() + 400}, 1);
    const Column<int> upper = column_of({entities.begin() + 200, entities.end()}, 1);
    std::vector<std::uint32_t> slots;
    join(
        all, [&](Entity entity, int, int, int) { slots.push_back(entity.slot); }, lower, upper);
    ASSERT_EQ(slots.size(), 200U);
    EXPECT_EQ(slots.front(), 200U);
    EXPECT_EQ(slots.back(), 399U);
}

TEST(Join, ShuffledOrdersGiveSamePairs) {
    EntityPool pool;
    std::vector<Entity> entities = make_entities(pool, 1000);
    const Column<int> driver = column_of(entities, 1);
    std::shuffle(entities.begin(), entities.end(), std::mt19937(3));
    const Column<int> other = column_of(entities, 10);
    const Visited visited = visit_all(driver, other);
    EXPECT_EQ(visited, visit_all_one_by_one(driver, other));
    EXPECT_EQ(visited.size(), 1000U);
}

TEST(Join, ColumnMayBeJoinedWithItself) {
    EntityPool pool;
    const Column<int> column = column_of(make_entities(pool, 500), 1);
    EXPECT_EQ(visit_all(column, column), visit_all_one_by_one(column, column));
}

// Equal first owners and equal lengths do not make blocks equal.
TEST(Join, DetectsOwnersSwappedInsideBlock) {
    EntityPool pool;
    std::vector<Entity> entities = make_entities(pool, 512);
    const Column<int> driver = column_of(entities, 1);
    for (const std::size_t at : {1U, 100U, 254U, 300U, 510U}) {
        std::vector<Entity> exchanged = entities;
        std::swap(exchanged[at], exchanged[at + 1]);
        const Column<int> other = column_of(exchanged, 10);
        EXPECT_EQ(visit_all(driver, other), visit_all_one_by_one(driver, other)) << at;
        EXPECT_EQ(visit_all(other, driver), visit_all_one_by_one(other, driver)) << at;
    }
}

TEST(Join, EqualSlotsOfDifferentGenerationsDoNotMatch) {
    EntityPool pool;
    const std::vector<Entity> old = make_entities(pool, 300);
    const Column<int> stale = column_of(old, 1);
    std::for_each(old.rbegin(), old.rend(), [&](Entity entity) { pool.destroy(entity); });
    const std::vector<Entity> fresh = make_entities(pool, 300);
    ASSERT_EQ(fresh.front().slot, old.front().slot);
    EXPECT_TRUE(visit_all(stale, column_of(fresh, 1)).empty());
}

RC_GTEST_PROP(Join, MatchesIndividualLookUpsAfterAnyHistory, ()) {
    EntityPool pool;
    const auto count = *rc::gen::inRange<std::size_t>(1, 1200);
    const std::vector<Entity> entities = make_entities(pool, count);
    Column<int> a = column_of(entities, 1);
    Column<int> b = column_of(entities, 10);
    // A few changes leave blocks equal, shifted or broken: all cases that the block comparison
    // distinguishes.
    const int changes = *rc::gen::inRange(0, 12);
    for (int i = 0; i < changes; ++i) {
        const Entity entity = entities[*rc::gen::inRange<std::size_t>(0, count)];
        Column<int>& column = *rc::gen::arbitrary<bool>() ? a : b;
        if (!column.remove(entity) || *rc::gen::arbitrary<bool>()) {
            column.add(entity, -i);
        }
    }
    RC_ASSERT(visit_all(a, b) == visit_all_one_by_one(a, b));
    RC_ASSERT(visit_all(b, a) == visit_all_one_by_one(b, a));
}

// Every third entity is destroyed and its slot reused; all sums have closed forms.
TEST(Join, MillionEntitiesAreCreatedDestroyedAndJoined) {
    constexpr std::size_t k_count = 1'000'000;
    EntityPool pool;
    std::vector<Entity> entities = make_entities(pool, k_count);
    Column<int> a = column_of(entities, 1);
    Column<int> b = column_of(entities, 2);
    for (std::size_t i = 0; i < k_count; i += 3) {
        ASSERT_TRUE(a.remove(entities[i]));
        ASSERT_TRUE(b.remove(entities[i]));
        ASSERT_TRUE(pool.destroy(entities[i]));
    }
    std::int64_t sum = 0;
    std::size_t visits = 0;
    const auto add = [&](Entity, int left, int right) {
        sum += left + right;
        ++visits;
    };
    join(a, add, b);
    constexpr std::size_t k_dead = (k_count + 2) / 3;
    constexpr auto k_n = static_cast<std::int64_t>(k_count);
    constexpr auto k_d = static_cast<std::int64_t>(k_dead);
    EXPECT_EQ(pool.alive_count(), k_count - k_dead);
    EXPECT_EQ(visits, k_count - k_dead);
    EXPECT_EQ(sum, 3 * (k_n * (k_n - 1) / 2 - 3 * k_d * (k_d - 1) / 2));
    for (std::size_t i = 0; i < k_dead; ++i) {
        const Entity entity = pool.create();
        ASSERT_LT(entity.slot, k_count) << "free slots come first";
        a.add(entity, 0);
    }
    visits = 0;
    join(a, add, b);
    EXPECT_EQ(visits, k_count - k_dead) << "the new ones have no element in b";
}

}  // namespace
}  // namespace handhold::join_test

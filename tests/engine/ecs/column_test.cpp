#include "engine/ecs/column.hpp"

#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace handhold::column_test {
namespace {

constexpr Entity entity_of(std::uint32_t slot, std::uint32_t generation = 1) {
    return {slot, generation};
}

Column<int> column_of(std::initializer_list<std::uint32_t> slots) {
    Column<int> column;
    for (const std::uint32_t slot : slots) {
        column.add(entity_of(slot), static_cast<int>(slot));
    }
    return column;
}

std::vector<std::uint32_t> slots_in_order(const Column<int>& column) {
    std::vector<std::uint32_t> slots;
    for (const Entity owner : column.owners()) {
        slots.push_back(owner.slot);
    }
    return slots;
}

TEST(Column, EmptyFindsNothing) {
    Column<int> column;
    EXPECT_TRUE(column.empty());
    EXPECT_TRUE(column.elements().empty());
    EXPECT_EQ(column.find(entity_of(0)), nullptr);
    EXPECT_EQ(column.find(k_no_entity), nullptr);
    EXPECT_FALSE(column.remove(entity_of(0)));
}

TEST(Column, RejectsNullEntityAndNeverFindsIt) {
    Column<int> column = column_of({0});
    EXPECT_THROW(column.add(k_no_entity), PreconditionError);
    EXPECT_EQ(column.find(k_no_entity), nullptr);
    EXPECT_FALSE(column.remove(k_no_entity));
    EXPECT_EQ(column.size(), 1U);
}

TEST(Column, RejectsSecondElementAndKeepsFirst) {
    Column<int> column = column_of({4});
    EXPECT_THROW(column.add(entity_of(4), 99), PreconditionError);
    EXPECT_EQ(column.size(), 1U);
    EXPECT_EQ(column.at(entity_of(4)), 4);
}

TEST(Column, RejectsElementInSlotOfStalePredecessor) {
    Column<int> column = column_of({4});
    const Entity next = entity_of(4, 2);
    EXPECT_EQ(column.find(next), nullptr);
    EXPECT_FALSE(column.remove(next));
    EXPECT_THROW(column.add(next), PreconditionError);
    column.remove(entity_of(4));
    column.add(next, 7);
    EXPECT_EQ(column.at(next), 7);
    EXPECT_EQ(column.find(entity_of(4)), nullptr) << "the old handle is stale";
}

TEST(Column, AtNamesFunctionAndSlotIfThereIsNoElement) {
    const Column<int> column = column_of({1});
    try {
        column.at(entity_of(12));
        FAIL() << "no exception";
    } catch (const PreconditionError& error) {
        const std::string message = error.what();
        EXPECT_NE(message.find("at:"), std::string::npos) << message;
        EXPECT_NE(message.find("12"), std::string::npos) << message;
    }
}

TEST(Column, RemoveMovesLastElementIntoGap) {
    Column<int> column = column_of({0, 1, 2, 3, 4});
    EXPECT_TRUE(column.remove(entity_of(1)));
    EXPECT_EQ(slots_in_order(column), (std::vector<std::uint32_t>{0, 4, 2, 3}));
    EXPECT_EQ(column.at(entity_of(4)), 4);
    EXPECT_TRUE(column.remove(entity_of(3)));
    EXPECT_EQ(slots_in_order(column), (std::vector<std::uint32_t>{0, 4, 2}));
    EXPECT_FALSE(column.remove(entity_of(3)));
}

TEST(Column, AddReturnsSameElementAsFind) {
    Column<int> column = column_of({9});
    int& element = column.add(entity_of(3));
    EXPECT_EQ(element, 0);
    element = 42;
    EXPECT_EQ(&element, column.find(entity_of(3)));
    EXPECT_EQ(column.elements()[1], 42);
    EXPECT_EQ(&std::as_const(column).at(entity_of(3)), &element);
}

TEST(Column, ReferencesSurviveValueChanges) {
    Column<int> column = column_of({0, 1, 2});
    int& element = column.at(entity_of(1));
    for (int& value : column.elements()) {
        value += 10;
    }
    EXPECT_EQ(element, 11);
}

TEST(Column, EqualHistoriesGiveEqualOrders) {
    const auto play = [] {
        Column<int> column = column_of({5, 3, 8, 1, 9});
        column.remove(entity_of(3));
        column.add(entity_of(2));
        column.remove(entity_of(5));
        return column;
    };
    EXPECT_EQ(slots_in_order(play()), slots_in_order(play()));
}

TEST(Column, CopyIsIndependent) {
    Column<int> column = column_of({0, 1, 2});
    const Column<int> snapshot = column;
    column.remove(entity_of(0));
    column.at(entity_of(1)) = 77;
    EXPECT_EQ(slots_in_order(snapshot), (std::vector<std::uint32_t>{0, 1, 2}));
    column = snapshot;
    EXPECT_EQ(column.at(entity_of(1)), 1);
    EXPECT_TRUE(column.contains(entity_of(0)));
}

TEST(Column, ClearRemovesAllElements) {
    Column<int> column = column_of({0, 1, 2});
    column.clear();
    EXPECT_TRUE(column.empty());
    EXPECT_FALSE(column.contains(entity_of(1)));
    column.add(entity_of(1), 5);
    EXPECT_EQ(column.at(entity_of(1)), 5);
}

TEST(Column, AcceptsMoveOnlyTypes) {
    Column<std::unique_ptr<int>> column;
    column.add(entity_of(0), std::make_unique<int>(1));
    column.add(entity_of(1), std::make_unique<int>(2));
    column.remove(entity_of(0));
    EXPECT_EQ(*column.at(entity_of(1)), 2);
}

TEST(Column, RunHasConsecutiveSlotsAndOneGeneration) {
    EXPECT_TRUE(column_of({4, 5, 6}).is_run(0));
    EXPECT_FALSE(column_of({4, 6}).is_run(0));
    Column<int> generations = column_of({4});
    generations.add(entity_of(5, 2));
    EXPECT_FALSE(generations.is_run(0));
}

// After any operations, a block that reports a run is one.
bool runs_are_true(const Column<int>& column) {
    const auto owners = column.owners();
    for (std::size_t index = 0; index < owners.size(); ++index) {
        const std::size_t in_block = index % Column<int>::k_block_elements;
        if (in_block != 0 && column.is_run(index / Column<int>::k_block_elements) &&
            owners[index] != Entity{owners[index - 1].slot + 1, owners[index - 1].generation}) {
            return false;
        }
    }
    return true;
}

RC_GTEST_PROP(Column, MatchesMapUnderAnyOperations, ()) {
    EntityPool pool;
    std::vector<Entity> handles = {k_no_entity};  // including stale ones
    Column<int> column;
    std::map<std::uint64_t, int> oracle;
    const auto key = [](Entity entity) {
        return (static_cast<std::uint64_t>(entity.slot) << 32U) | entity.generation;
    };
    const int operations = *rc::gen::inRange(0, 2000);
    for (int i = 0; i < operations; ++i) {
        const Entity any = handles[*rc::gen::inRange<std::size_t>(0, handles.size())];
        if (*rc::gen::inRange(0, 3) != 0) {
            const Entity entity = pool.create();
            handles.push_back(entity);
            column.add(entity, i);
            oracle[key(entity)] = i;
        } else if (pool.destroy(any)) {
            RC_ASSERT(column.remove(any));
            oracle.erase(key(any));
        } else {
            RC_ASSERT(!column.remove(any));
        }
    }
    RC_ASSERT(column.size() == oracle.size());
    RC_ASSERT(pool.alive_count() == oracle.size());
    RC_ASSERT(runs_are_true(column));
    for (const Entity entity : handles) {
        const auto expected = oracle.find(key(entity));
        const int* const found = column.find(entity);
        RC_ASSERT((found != nullptr) == (expected != oracle.end()));
        RC_ASSERT(pool.is_alive(entity) == (found != nullptr));
        if (found != nullptr) {
            RC_ASSERT(*found == expected->second);
        }
    }
    for (std::size_t index = 0; index < column.size(); ++index) {
        RC_ASSERT(column.find_index(column.owners()[index]) == index);
    }
}

}  // namespace
}  // namespace handhold::column_test

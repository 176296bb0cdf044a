#include "engine/solver/sparse/plan_cache.hpp"

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "engine/solver/packed/triad_plan.hpp"
#include "tests/engine/allocation_count.hpp"

namespace handhold::solver_plan_cache_test {
namespace {

// A rope on an immovable body; one of its nodes has its ends swapped.
std::vector<RowNode> rope(std::uint32_t bodies, std::uint32_t swapped) {
    std::vector<RowNode> nodes{{{k_no_slot, 0}, 3, false, true}};
    for (std::uint32_t i = 1; i < bodies; ++i) {
        nodes.push_back({{i - 1, i}, 3, false, true});
    }
    std::swap(nodes[swapped].slots[0], nodes[swapped].slots[1]);
    return nodes;
}

// Allocations when planning ropes of one length, after the first.
template <typename Plan>
std::size_t allocations_of_ropes_alike() {
    constexpr std::uint32_t k_bodies = 150;
    const std::vector<std::uint8_t> turns(k_bodies, 1);
    PlanCache<Plan> plans;
    plans.choose(rope(k_bodies, 0), turns);
    std::size_t count = 0;
    for (std::uint32_t swapped = 1; swapped < 20; ++swapped) {
        const std::vector<RowNode> nodes = rope(k_bodies, swapped);
        const std::size_t before = allocation_count();
        plans.choose(nodes, turns);
        count += allocation_count() - before;
    }
    return count;
}

TEST(PlanCache, OnlyTheFirstPlanOfASizeAllocates) {
    if (!counts_allocations()) {
        GTEST_SKIP() << "the sanitizer brings operators of its own";
    }
    EXPECT_EQ(allocations_of_ropes_alike<EliminationPlan>(), 0U);
    EXPECT_EQ(allocations_of_ropes_alike<TriadPlan>(), 0U);
}

}  // namespace
}  // namespace handhold::solver_plan_cache_test

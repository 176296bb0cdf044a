#include <algorithm>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "engine/solver/packed/strand_plan.hpp"
#include "tests/random.hpp"

namespace handhold::solver_strands_test {
namespace {

using test::Random;

RowNode link_between(std::uint32_t a, std::uint32_t b) { return {{a, b}, 3, false, true}; }

// Links between consecutive bodies, in random order and orientation; the first may be attached to
// an immovable body.
std::vector<RowNode> rope(std::uint32_t bodies, bool is_anchored, Random& random) {
    std::vector<RowNode> nodes;
    if (is_anchored) {
        nodes.push_back(link_between(k_no_slot, 0));
    }
    for (std::uint32_t i = 1; i < bodies; ++i) {
        nodes.push_back(link_between(i - 1, i));
    }
    for (RowNode& node : nodes) {
        if (random.engine()() % 2 == 0) {
            std::swap(node.slots[0], node.slots[1]);
        }
    }
    std::shuffle(nodes.begin(), nodes.end(), random.engine());
    return nodes;
}

StrandPlan plan_of(const std::vector<RowNode>& nodes, std::uint32_t bodies) {
    StrandPlan plan;
    plan.build(nodes, std::vector<std::uint8_t>(bodies, 1));
    return plan;
}

std::uint32_t far_slot(const RowNode& node, std::uint32_t end) { return node.slots[1 - end % 2]; }

// Every node and every body is in exactly one place, and each strand body has only the links before
// and after its row.
void expect_strands_apart(const StrandPlan& plan, const std::vector<RowNode>& nodes,
                          std::uint32_t bodies) {
    std::vector<int> uses(nodes.size(), 0);
    std::vector<int> rows(bodies, 0);
    for (const std::uint32_t node : plan.rest()) {
        ++uses[node];
    }
    for (const StrandPlan::StrandPack& strand_pack : plan.strand_packs()) {
        for (std::size_t lane = 0; lane < 4; ++lane) {
            for (std::uint32_t k = 0; k < strand_pack.length; ++k) {
                const std::uint32_t end = plan.links()[strand_pack.links + k][lane];
                ++uses[end / 2];
                EXPECT_EQ(nodes[end / 2].slots[end % 2], plan.bodies()[strand_pack.row + k][lane]);
                EXPECT_EQ(far_slot(nodes[end / 2], end),
                          plan.bodies()[strand_pack.row + k + 1][lane]);
            }
            for (std::uint32_t k = 0; k <= strand_pack.length; ++k) {
                const std::uint32_t slot = plan.bodies()[strand_pack.row + k][lane];
                if (slot != k_no_slot) {
                    ++rows[slot];
                }
            }
        }
    }
    EXPECT_TRUE(std::ranges::all_of(uses, [](int count) { return count == 1; }));
    for (const std::uint32_t slot : plan.rest_slots()) {
        ++rows[slot];
    }
    EXPECT_TRUE(std::ranges::all_of(rows, [](int count) { return count == 1; }));
}

// Among the triads that are in no strand, each that joins a strand refers to it as to one body.
void expect_rest_holds_strands(const StrandPlan& plan, const std::vector<RowNode>& nodes) {
    for (std::size_t i = 0; i < plan.strand_packs().size(); ++i) {
        const StrandPlan::StrandPack& strand_pack = plan.strand_packs()[i];
        for (std::uint32_t lane = 0; lane < 4; ++lane) {
            const auto strand = static_cast<std::uint32_t>(plan.slot_count() + 4 * i) + lane;
            for (const auto& [end, row] :
                 {std::pair(strand_pack.before[lane], strand_pack.row),
                  std::pair(strand_pack.after[lane], strand_pack.row + strand_pack.length)}) {
                if (end != k_no_slot) {
                    EXPECT_EQ(plan.rest_nodes()[end / 2].slots[end % 2], strand);
                    EXPECT_EQ(nodes[plan.rest()[end / 2]].slots[end % 2], plan.bodies()[row][lane]);
                }
            }
        }
    }
}

TEST(StrandPlan, RopeHasFourEqualStrandsAndSeparators) {
    Random random(1);
    for (std::uint32_t bodies = 40; bodies < 60; ++bodies) {
        SCOPED_TRACE(bodies);
        const std::vector<RowNode> nodes = rope(bodies, bodies % 2 == 0, random);
        const StrandPlan plan = plan_of(nodes, bodies);
        ASSERT_EQ(plan.strand_packs().size(), 1U);
        EXPECT_EQ(plan.strand_packs()[0].length, (nodes.size() - 3) / 4);
        EXPECT_EQ(plan.rest().size(), nodes.size() - 4 * plan.strand_packs()[0].length);
        expect_strands_apart(plan, nodes, bodies);
        expect_rest_holds_strands(plan, nodes);
    }
}

TEST(StrandPlan, RingIsCutOnceMore) {
    Random random(2);
    std::vector<RowNode> nodes = rope(44, false, random);
    nodes.push_back(link_between(43, 0));
    const StrandPlan plan = plan_of(nodes, 44);
    ASSERT_EQ(plan.strand_packs().size(), 1U);
    EXPECT_EQ(plan.strand_packs()[0].length, 10U);
    expect_strands_apart(plan, nodes, 44);
    expect_rest_holds_strands(plan, nodes);
    EXPECT_TRUE(std::ranges::none_of(plan.strand_packs()[0].before,
                                     [](std::uint32_t end) { return end == k_no_slot; }));
}

// A branch at the middle of a rope divides it into two runs.
TEST(StrandPlan, BranchEndsTheRuns) {
    Random random(3);
    std::vector<RowNode> nodes = rope(100, true, random);
    nodes.push_back(link_between(50, 100));
    const StrandPlan plan = plan_of(nodes, 101);
    ASSERT_EQ(plan.strand_packs().size(), 2U);
    expect_strands_apart(plan, nodes, 101);
    expect_rest_holds_strands(plan, nodes);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        if (nodes[i].slots[0] == 50 || nodes[i].slots[1] == 50) {
            EXPECT_NE(plan.places()[i], k_no_slot);
        }
    }
}

TEST(StrandPlan, ShortRunsAndDrivesHaveNoStrands) {
    Random random(4);
    EXPECT_TRUE(plan_of(rope(18, true, random), 18).strand_packs().empty());
    EXPECT_EQ(plan_of(rope(19, true, random), 19).strand_packs().size(), 1U);
    std::vector<RowNode> drives = rope(60, true, random);
    for (RowNode& node : drives) {
        node.is_point_link = false;
    }
    const StrandPlan plan = plan_of(drives, 60);
    EXPECT_TRUE(plan.strand_packs().empty());
    EXPECT_TRUE(std::ranges::equal(plan.rest_nodes(), drives));
}

}  // namespace
}  // namespace handhold::solver_strands_test

#include "engine/solver/model/islands.hpp"

#include <algorithm>
#include <numeric>
#include <set>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "engine/core/check.hpp"
#include "engine/solver/contact/contact_rows.hpp"
#include "tests/engine/solver/scene.hpp"

namespace handhold::solver_islands_test {
namespace {

using test::Random;

std::uint32_t below(std::size_t count, Random& random) {
    return static_cast<std::uint32_t>(random.engine()() % count);
}

// Bodies with sorted, not contiguous ids; about one in four is fixed. No block connects two fixed
// bodies, as in a frame.
ConstraintGraph random_graph(Random& random) {
    ConstraintGraph graph;
    const std::uint32_t bodies = 2 + below(30, random);
    for (std::uint32_t i = 0; i < bodies; ++i) {
        const std::uint64_t id = 10 * (i + 1);
        graph.bodies.push_back(below(4, random) == 0 ? test::fixed_body(id)
                                                     : test::ball(id, 1.0, 0.1));
    }
    const std::uint32_t blocks = below(40, random);
    for (std::uint32_t i = 0; i < blocks; ++i) {
        const RowKind kind = below(2, random) == 0 ? RowKind::drive_point : RowKind::contact;
        const std::uint32_t a = below(bodies, random);
        RowBlock block = test::row_block(kind, a, below(bodies, random));
        block.key = i;
        const bool moves = graph.bodies[block.a].role != BodyRole::fixed ||
                           graph.bodies[block.b].role != BodyRole::fixed;
        if (block.a != block.b && moves) {
            graph.blocks.push_back(block);
        }
    }
    sort_blocks(graph);
    return graph;
}

using Members = std::set<std::uint32_t>;

std::set<Members> islands_of(const ConstraintGraph& graph) {
    std::set<Members> islands;
    for (const Island& island : graph.islands) {
        const auto bodies = graph.bodies_of(island);
        islands.insert(Members(bodies.begin(), bodies.end()));
    }
    return islands;
}

// Oracle: flood fill from each unvisited body over blocks between movable bodies.
std::set<Members> flood_filled(const ConstraintGraph& graph) {
    const auto moves = [&graph](std::uint32_t i) {
        return graph.bodies[i].role != BodyRole::fixed;
    };
    Members in_a_block;
    for (const RowBlock& block : graph.blocks) {
        in_a_block.insert({block.a, block.b});
    }
    std::set<Members> islands;
    Members seen;
    for (const std::uint32_t first : in_a_block) {
        if (!moves(first) || seen.contains(first)) {
            continue;
        }
        Members island = {first};
        for (std::size_t before = 0; before != island.size();) {
            before = island.size();
            for (const RowBlock& block : graph.blocks) {
                if (moves(block.a) && moves(block.b) &&
                    (island.contains(block.a) || island.contains(block.b))) {
                    island.insert({block.a, block.b});
                }
            }
        }
        seen.insert(island.begin(), island.end());
        islands.insert(island);
    }
    return islands;
}

RC_GTEST_PROP(Islands, EqualTheComponentsOfAFloodFill, (std::uint64_t seed)) {
    Random random(seed);
    ConstraintGraph graph = random_graph(random);
    build_islands(graph);
    RC_ASSERT(islands_of(graph) == flood_filled(graph));
}

RC_GTEST_PROP(Islands, ContainEveryBlockOnceWithItsBodies, (std::uint64_t seed)) {
    Random random(seed);
    ConstraintGraph graph = random_graph(random);
    build_islands(graph);
    std::vector<std::uint32_t> blocks;
    for (const Island& island : graph.islands) {
        const auto members = graph.bodies_of(island);
        for (const std::uint32_t i : graph.blocks_of(island)) {
            blocks.push_back(i);
            for (const std::uint32_t body : {graph.blocks[i].a, graph.blocks[i].b}) {
                const bool inside = std::ranges::find(members, body) != members.end();
                RC_ASSERT(inside == (graph.bodies[body].role != BodyRole::fixed));
            }
        }
    }
    std::ranges::sort(blocks);
    RC_ASSERT(blocks.size() == graph.blocks.size());
    for (std::uint32_t i = 0; i < blocks.size(); ++i) {
        RC_ASSERT(blocks[i] == i);
    }
}

RC_GTEST_PROP(Islands, AreSortedAndSlotsNumberTheirBodies, (std::uint64_t seed)) {
    Random random(seed);
    ConstraintGraph graph = random_graph(random);
    build_islands(graph);
    std::int64_t last_first = -1;
    for (const Island& island : graph.islands) {
        const auto bodies = graph.bodies_of(island);
        RC_ASSERT(!bodies.empty());
        RC_ASSERT(static_cast<std::int64_t>(bodies[0]) > last_first);
        last_first = bodies[0];
        RC_ASSERT(std::ranges::is_sorted(bodies));
        RC_ASSERT(std::ranges::is_sorted(graph.blocks_of(island)));
        for (std::uint32_t slot = 0; slot < bodies.size(); ++slot) {
            RC_ASSERT(graph.bodies[bodies[slot]].slot == slot);
        }
    }
}

RC_GTEST_PROP(Islands, DoNotDependOnTheOrderOfDetection, (std::uint64_t seed)) {
    Random random(seed);
    ConstraintGraph graph = random_graph(random);
    ConstraintGraph shuffled = graph;
    std::shuffle(shuffled.blocks.begin(), shuffled.blocks.end(), random.engine());
    sort_blocks(shuffled);
    build_islands(graph);
    build_islands(shuffled);
    const auto same_block = [](const RowBlock& x, const RowBlock& y) {
        return std::tie(x.a, x.b, x.kind, x.key) == std::tie(y.a, y.b, y.kind, y.key);
    };
    RC_ASSERT(std::ranges::equal(graph.blocks, shuffled.blocks, same_block));
    RC_ASSERT(graph.island_bodies == shuffled.island_bodies);
    RC_ASSERT(graph.island_blocks == shuffled.island_blocks);
}

// As in a frame: bodies are rewritten, the topology is unchanged.
RC_GTEST_PROP(Islands, AreKeptWhileTheTopologyIsUnchanged, (std::uint64_t seed)) {
    Random random(seed);
    ConstraintGraph graph = random_graph(random);
    build_islands(graph);
    ConstraintGraph again = graph;
    for (SolverBody& body : again.bodies) {
        body.slot = 77;
    }
    build_islands(again);
    RC_ASSERT(again.revision != graph.revision);
    RC_ASSERT(again.island_bodies == graph.island_bodies);
    RC_ASSERT(again.island_blocks == graph.island_blocks);
    for (const std::uint32_t body : graph.island_bodies) {
        RC_ASSERT(again.bodies[body].slot == graph.bodies[body].slot);
    }
}

// One body becomes fixed, which separates the bodies it connected.
RC_GTEST_PROP(Islands, AreRebuiltWhenARoleChanges, (std::uint64_t seed)) {
    Random random(seed);
    ConstraintGraph graph = random_graph(random);
    build_islands(graph);
    graph.bodies[below(graph.bodies.size(), random)].role = BodyRole::fixed;
    std::erase_if(graph.blocks, [&graph](const RowBlock& block) {
        return graph.bodies[block.a].role == BodyRole::fixed &&
               graph.bodies[block.b].role == BodyRole::fixed;
    });
    build_islands(graph);
    RC_ASSERT(islands_of(graph) == flood_filled(graph));
}

RC_GTEST_PROP(Islands, DoNotDependOnThePreviousGraph, (std::uint64_t seed)) {
    Random random(seed);
    ConstraintGraph fresh = random_graph(random);
    ConstraintGraph reused = random_graph(random);
    build_islands(reused);
    reused.bodies = fresh.bodies;
    reused.blocks = fresh.blocks;
    build_islands(fresh);
    build_islands(reused);
    RC_ASSERT(islands_of(fresh) == islands_of(reused));
    RC_ASSERT(fresh.island_blocks == reused.island_blocks);
}

RC_GTEST_PROP(Islands, SortPutsTheLargestFirstAndTiesByIndex, (std::uint64_t seed)) {
    Random random(seed);
    ConstraintGraph graph = random_graph(random);
    build_islands(graph);
    std::vector<std::uint32_t> order(graph.islands.size());
    std::iota(order.begin(), order.end(), 0U);
    std::shuffle(order.begin(), order.end(), random.engine());
    sort_largest_first(graph, order);
    for (std::size_t i = 1; i < order.size(); ++i) {
        const std::size_t before = graph.blocks_of(graph.islands[order[i - 1]]).size();
        const std::size_t here = graph.blocks_of(graph.islands[order[i]]).size();
        RC_ASSERT(before > here || (before == here && order[i - 1] < order[i]));
    }
}

TEST(Islands, FixedBodiesSeparateThem) {
    // Ball, fixed body, ball; the second ball touches a third.
    ConstraintGraph graph;
    graph.bodies = {test::ball(1, 1.0, 0.1), test::fixed_body(2), test::ball(3, 1.0, 0.1),
                    test::ball(4, 1.0, 0.1)};
    graph.blocks = {test::row_block(RowKind::contact, 0, 1),
                    test::row_block(RowKind::contact, 2, 1),
                    test::row_block(RowKind::contact, 2, 3)};
    build_islands(graph);
    EXPECT_EQ(islands_of(graph), (std::set<Members>{{0}, {2, 3}}));
}

TEST(Islands, TranslatingAndHeavyBodiesConnectThem) {
    // Which phases move them changes within a frame; the islands do not.
    ConstraintGraph graph;
    graph.bodies = {test::translating_body(1, 80.0), test::ball(2, 5000.0, 0.5),
                    test::ball(3, 1.0, 0.1)};
    graph.bodies[1].role = BodyRole::heavy;
    graph.bodies[1].inverse_mass = 0.0;
    graph.blocks = {test::row_block(RowKind::drive_point, 0, 1),
                    test::row_block(RowKind::contact, 2, 1)};
    build_islands(graph);
    EXPECT_EQ(islands_of(graph), (std::set<Members>{{0, 1, 2}}));
}

TEST(Islands, BodyWithoutABlockBelongsToNone) {
    ConstraintGraph graph;
    graph.bodies = {test::ball(1, 1.0, 0.1), test::ball(2, 1.0, 0.1)};
    build_islands(graph);
    EXPECT_TRUE(graph.islands.empty());
    EXPECT_TRUE(graph.island_bodies.empty());
}

TEST(FindBody, FindsEveryIdAndNoOther) {
    ConstraintGraph graph;
    EXPECT_EQ(find_body(graph, 5), 0U);
    graph.bodies = {test::fixed_body(3), test::fixed_body(5), test::fixed_body(9)};
    EXPECT_EQ(find_body(graph, 3), 0U);
    EXPECT_EQ(find_body(graph, 5), 1U);
    EXPECT_EQ(find_body(graph, 9), 2U);
    for (const std::uint64_t absent : {0U, 4U, 10U}) {
        EXPECT_EQ(find_body(graph, absent), graph.bodies.size());
    }
}

// --- Contact rows --------------------------------------------------------------------------------

ConstraintGraph driver_at_a_wall() {
    ConstraintGraph graph;
    graph.bodies = {test::fixed_body(3), test::translating_body(7, 80.0)};
    graph.bodies[0].restitution = 0.6;
    graph.bodies[1].restitution = 0.2;
    graph.bodies[1].collider_offset_bs = Vec3(0.1, 1.6, 0.0);
    graph.blocks = {test::row_block(RowKind::drive_point, 1, 0),
                    test::row_block(RowKind::contact, 1, 0)};
    return graph;
}

TEST(ReplaceContactRows, KeepsDrivesAndUsesColliderOffsetAndLargerRestitution) {
    ConstraintGraph graph = driver_at_a_wall();
    ContactPoint contact;
    contact.id_a = 7;
    contact.id_b = 3;
    contact.point_a_bs = Vec3(0.0, 0.0, -0.11);
    contact.point_b_bs = Vec3(1.0, 2.0, 3.0);
    contact.normal_b_bs = Vec3::UnitZ();
    contact.feature = 4;
    replace_contact_rows(std::span(&contact, 1), graph);
    ASSERT_EQ(graph.blocks.size(), 2U);
    const RowBlock& block = graph.blocks[1];
    EXPECT_TRUE(is_drive(graph.blocks[0]));
    EXPECT_EQ(block.kind, RowKind::contact);
    EXPECT_EQ(block.a, 1U);
    EXPECT_EQ(block.b, 0U);
    EXPECT_EQ(block.key, 4U);
    EXPECT_EQ(block.point_a_bs, Vec3(Vec3(0.1, 1.6, 0.0) + Vec3(0.0, 0.0, -0.11)));
    EXPECT_EQ(block.point_b_bs, Vec3(1.0, 2.0, 3.0));
    EXPECT_EQ(block.normal_b_bs, Vec3(Vec3::UnitZ()));
    EXPECT_EQ(block.restitution, 0.6);
    EXPECT_EQ(graph.islands.size(), 1U);
}

TEST(ReplaceContactRows, WithoutContactsOnlyDrivesRemain) {
    ConstraintGraph graph = driver_at_a_wall();
    replace_contact_rows({}, graph);
    ASSERT_EQ(graph.blocks.size(), 1U);
    EXPECT_TRUE(is_drive(graph.blocks[0]));
}

TEST(ReplaceContactRows, ContactOfAnUnknownBodyIsRefused) {
    ConstraintGraph graph = driver_at_a_wall();
    ContactPoint contact;
    contact.id_a = 7;
    contact.id_b = 4;
    EXPECT_THROW(replace_contact_rows(std::span(&contact, 1), graph), PreconditionError);
}

}  // namespace
}  // namespace handhold::solver_islands_test

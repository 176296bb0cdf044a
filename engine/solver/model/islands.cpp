// Solver, model: island building by union-find, in an order that depends on persistent ids only.
#include "engine/solver/model/islands.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <tuple>

#include "engine/core/disjoint_sets.hpp"

namespace handhold {
namespace {

constexpr std::uint32_t k_none = std::numeric_limits<std::uint32_t>::max();

bool is_movable(const SolverBody& body) { return body.role != BodyRole::fixed; }

// The smaller index becomes the root, so an island is identified by its first body.
void unite_blocks(ConstraintGraph& graph) {
    graph.parent.resize(graph.bodies.size());
    std::iota(graph.parent.begin(), graph.parent.end(), 0U);
    graph.root_of_block.clear();
    for (const RowBlock& block : graph.blocks) {
        const bool moves_a = is_movable(graph.bodies[block.a]);
        if (moves_a && is_movable(graph.bodies[block.b])) {
            const std::uint32_t root_a = find_root(graph.parent, block.a);
            const std::uint32_t root_b = find_root(graph.parent, block.b);
            graph.parent[std::max(root_a, root_b)] = std::min(root_a, root_b);
        }
        graph.root_of_block.push_back(moves_a ? block.a : block.b);
    }
    // A root precedes all other members of its set, so one pass makes every body's parent its root.
    for (std::uint32_t& parent : graph.parent) {
        parent = graph.parent[parent];
    }
    for (std::uint32_t& root : graph.root_of_block) {
        root = graph.parent[root];
    }
}

// Second half of a counting sort. In: the islands' member counts, in their `end` fields. Out:
// ranges, and each island's members in ascending order.
void place_members(ConstraintGraph& graph) {
    std::uint32_t bodies = 0;
    std::uint32_t blocks = 0;
    for (Island& island : graph.islands) {
        island.bodies_begin = bodies;
        bodies += island.bodies_end;
        island.bodies_end = island.bodies_begin;
        island.blocks_begin = blocks;
        blocks += island.blocks_end;
        island.blocks_end = island.blocks_begin;
    }
    graph.island_bodies.resize(bodies);
    graph.island_blocks.resize(blocks);
    for (std::uint32_t i = 0; i < graph.bodies.size(); ++i) {
        const std::uint32_t index = graph.island_of_root[graph.parent[i]];
        if (is_movable(graph.bodies[i]) && index != k_none) {
            Island& island = graph.islands[index];
            graph.island_bodies[island.bodies_end++] = i;
        }
    }
    for (std::uint32_t i = 0; i < graph.blocks.size(); ++i) {
        Island& island = graph.islands[graph.island_of_root[graph.root_of_block[i]]];
        graph.island_blocks[island.blocks_end++] = i;
    }
}

// True if movability and the bodies of every block are as when the islands were built.
bool has_same_topology(const ConstraintGraph& graph) {
    const auto is_same_body = [](const SolverBody& body, std::uint8_t was_movable) {
        return is_movable(body) == (was_movable != 0);
    };
    const auto is_same_block = [](const RowBlock& block, const std::array<std::uint32_t, 2>& tie) {
        return block.a == tie[0] && block.b == tie[1];
    };
    return std::ranges::equal(graph.bodies, graph.are_movable, is_same_body) &&
           std::ranges::equal(graph.blocks, graph.block_bodies, is_same_block);
}

void record_topology(ConstraintGraph& graph) {
    graph.are_movable.clear();
    for (const SolverBody& body : graph.bodies) {
        graph.are_movable.push_back(is_movable(body) ? 1 : 0);
    }
    graph.block_bodies.clear();
    for (const RowBlock& block : graph.blocks) {
        graph.block_bodies.push_back({block.a, block.b});
    }
}

// Marks the islands that are heaps, and their loose bodies.
void mark_heaps(ConstraintGraph& graph) {
    for (Island& island : graph.islands) {
        const std::span<const std::uint32_t> bodies = graph.bodies_of(island);
        const std::span<const std::uint32_t> blocks = graph.blocks_of(island);
        const bool may_be_heap = blocks.size() > k_max_direct_contacts;
        for (const std::uint32_t i : bodies) {
            graph.bodies[i].in_heap = may_be_heap && graph.bodies[i].role != BodyRole::translating;
        }
        island.is_heap = false;
        if (!may_be_heap) {
            continue;
        }
        for (const std::uint32_t i : blocks) {
            if (const RowBlock& block = graph.blocks[i]; !is_contact(block)) {
                graph.bodies[block.a].in_heap = graph.bodies[block.b].in_heap = false;
            }
        }
        const auto loose_contacts = std::ranges::count_if(blocks, [&](std::uint32_t i) {
            const RowBlock& block = graph.blocks[i];
            return graph.bodies[block.a].in_heap || graph.bodies[block.b].in_heap;
        });
        island.is_heap = loose_contacts > k_max_direct_contacts;
        for (const std::uint32_t i : bodies) {
            graph.bodies[i].in_heap = graph.bodies[i].in_heap && island.is_heap;
        }
    }
}

// Bodies are rewritten every frame, so their slots must be too.
void assign_slots(ConstraintGraph& graph) {
    for (const Island& island : graph.islands) {
        std::uint32_t slot = 0;
        for (const std::uint32_t body : graph.bodies_of(island)) {
            graph.bodies[body].slot = slot++;
        }
    }
}

}  // namespace

std::size_t find_body(const ConstraintGraph& graph, std::uint64_t id) {
    const auto found = std::lower_bound(
        graph.bodies.begin(), graph.bodies.end(), id,
        [](const SolverBody& body, std::uint64_t wanted) { return body.id < wanted; });
    return found != graph.bodies.end() && found->id == id
               ? static_cast<std::size_t>(found - graph.bodies.begin())
               : graph.bodies.size();
}

// Blocks are large, so an index array is sorted and each block is copied at most once.
void sort_blocks(ConstraintGraph& graph) {
    using Place = ConstraintGraph::BlockPlace;
    const auto is_before = [](const Place& x, const Place& y) {
        return std::tie(x.a, x.b, x.kind, x.key, x.index) <
               std::tie(y.a, y.b, y.kind, y.key, y.index);
    };
    std::vector<RowBlock>& blocks = graph.blocks;
    if (std::ranges::is_sorted(blocks, [](const RowBlock& x, const RowBlock& y) {
            return std::tie(x.a, x.b, x.kind, x.key) < std::tie(y.a, y.b, y.kind, y.key);
        })) {
        return;
    }
    graph.places.clear();
    for (std::uint32_t i = 0; i < blocks.size(); ++i) {
        graph.places.push_back({blocks[i].key, blocks[i].a, blocks[i].b, i, blocks[i].kind});
    }
    std::ranges::sort(graph.places, is_before);
    graph.sorted_blocks.clear();
    for (const Place& place : graph.places) {
        graph.sorted_blocks.push_back(blocks[place.index]);
    }
    std::swap(blocks, graph.sorted_blocks);
}

void build_islands(ConstraintGraph& graph) {
    ++graph.revision;
    if (has_same_topology(graph)) {
        assign_slots(graph);
        mark_heaps(graph);
        return;
    }
    record_topology(graph);
    unite_blocks(graph);
    graph.islands.clear();
    graph.island_of_root.assign(graph.bodies.size(), k_none);
    for (const std::uint32_t root : graph.root_of_block) {
        graph.island_of_root[root] = 0;  // marks the island; numbered below
    }
    for (std::uint32_t i = 0; i < graph.bodies.size(); ++i) {
        if (graph.parent[i] == i && graph.island_of_root[i] != k_none) {
            graph.island_of_root[i] = static_cast<std::uint32_t>(graph.islands.size());
            graph.islands.push_back({});
        }
    }
    for (std::uint32_t i = 0; i < graph.bodies.size(); ++i) {
        const std::uint32_t index = graph.island_of_root[graph.parent[i]];
        if (is_movable(graph.bodies[i]) && index != k_none) {
            ++graph.islands[index].bodies_end;
        }
    }
    for (const std::uint32_t root : graph.root_of_block) {
        ++graph.islands[graph.island_of_root[root]].blocks_end;
    }
    place_members(graph);
    assign_slots(graph);
    mark_heaps(graph);
}

void sort_largest_first(const ConstraintGraph& graph, std::span<std::uint32_t> islands) {
    std::ranges::sort(islands, [&graph](std::uint32_t x, std::uint32_t y) {
        const std::size_t blocks_x = graph.blocks_of(graph.islands[x]).size();
        const std::size_t blocks_y = graph.blocks_of(graph.islands[y]).size();
        return blocks_x != blocks_y ? blocks_x > blocks_y : x < y;
    });
}

std::size_t heap_block_count(const ConstraintGraph& graph) {
    std::size_t count = 0;
    for (const Island& island : graph.islands) {
        count += island.is_heap ? graph.blocks_of(island).size() : 0;
    }
    return count;
}

bool is_heap_contact(std::span<const SolverBody> bodies, const RowBlock& block) {
    const SolverBody& a = bodies[block.a];
    const SolverBody& b = bodies[block.b];
    return is_contact(block) && (a.in_heap || b.in_heap) &&
           (a.in_heap || a.role == BodyRole::fixed) && (b.in_heap || b.role == BodyRole::fixed);
}

IslandErrors island_errors(const ConstraintGraph& graph, const Island& island) {
    IslandErrors errors;
    for (const std::uint32_t i : graph.blocks_of(island)) {
        const RowBlock& block = graph.blocks[i];
        double& worst = is_drive(block)                        ? errors.drives_m
                        : !is_contact(block)                   ? errors.joints_m
                        : is_heap_contact(graph.bodies, block) ? errors.heap_m
                                                               : errors.contacts_m;
        worst = std::max(worst, block_error_m(graph.bodies, block));
    }
    return errors;
}

}  // namespace handhold

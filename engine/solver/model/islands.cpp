// Solver, model: island building by union-find, in an order that depends on persistent ids only.
#include "engine/solver/model/islands.hpp"

#include <algorithm>
#include <tuple>

#include "engine/core/disjoint_sets.hpp"

namespace handhold {
namespace {

bool is_movable(const SolverBody& body) { return body.role != BodyRole::fixed; }

ConstraintGraph::Tie tie_of(const ConstraintGraph& graph, const RowBlock& block) {
    return {block.a, block.b, is_movable(graph.bodies[block.a]), is_movable(graph.bodies[block.b])};
}

void find_members(ConstraintGraph& graph) {
    graph.is_member.resize(std::max(graph.is_member.size(), graph.bodies.size()), 0);
    graph.members.clear();
    const auto add = [&graph](std::uint32_t body) {
        if (graph.is_member[body] == 0) {
            graph.is_member[body] = 1;
            graph.members.push_back(body);
        }
    };
    for (const ConstraintGraph::Tie& tie : graph.ties) {
        if (tie.moves_a) {
            add(tie.a);
        }
        if (tie.moves_b || !tie.moves_a) {  // two fixed bodies make an island without bodies
            add(tie.b);
        }
    }
    std::ranges::sort(graph.members);
    for (const std::uint32_t body : graph.members) {
        graph.is_member[body] = 0;
    }
}

// The smaller index becomes the root, so an island is identified by its first body.
void unite_blocks(ConstraintGraph& graph) {
    graph.parent.resize(graph.bodies.size());
    for (const std::uint32_t body : graph.members) {
        graph.parent[body] = body;
    }
    graph.root_of_block.clear();
    for (const ConstraintGraph::Tie& tie : graph.ties) {
        if (tie.moves_a && tie.moves_b) {
            const std::uint32_t root_a = find_root(graph.parent, tie.a);
            const std::uint32_t root_b = find_root(graph.parent, tie.b);
            graph.parent[std::max(root_a, root_b)] = std::min(root_a, root_b);
        }
        graph.root_of_block.push_back(tie.moves_a ? tie.a : tie.b);
    }
    // A root precedes all other members of its set, so one pass makes every body's parent its root.
    for (const std::uint32_t body : graph.members) {
        graph.parent[body] = graph.parent[graph.parent[body]];
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
    for (const std::uint32_t i : graph.members) {
        if (is_movable(graph.bodies[i])) {
            Island& island = graph.islands[graph.island_of_root[graph.parent[i]]];
            graph.island_bodies[island.bodies_end++] = i;
        }
    }
    for (std::uint32_t i = 0; i < graph.blocks.size(); ++i) {
        Island& island = graph.islands[graph.island_of_root[graph.root_of_block[i]]];
        graph.island_blocks[island.blocks_end++] = i;
    }
}

// True if every block has the same bodies, and the same bodies can move, as when the islands were
// built.
bool has_same_topology(const ConstraintGraph& graph) {
    return std::ranges::equal(graph.blocks, graph.ties,
                              [&graph](const RowBlock& block, const ConstraintGraph::Tie& tie) {
                                  return tie_of(graph, block) == tie;
                              });
}

void record_topology(ConstraintGraph& graph) {
    graph.ties.clear();
    for (const RowBlock& block : graph.blocks) {
        graph.ties.push_back(tie_of(graph, block));
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
    find_members(graph);
    unite_blocks(graph);
    graph.islands.clear();
    graph.island_of_root.resize(graph.bodies.size());
    for (const std::uint32_t i : graph.members) {
        if (graph.parent[i] == i) {
            graph.island_of_root[i] = static_cast<std::uint32_t>(graph.islands.size());
            graph.islands.push_back({});
        }
    }
    for (const std::uint32_t i : graph.members) {
        if (is_movable(graph.bodies[i])) {
            ++graph.islands[graph.island_of_root[graph.parent[i]]].bodies_end;
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

#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/solver/model/rows.hpp"

// The frame's constraints as a graph, and its islands: sets of bodies that can push one another.
namespace handhold {

struct Island {
    std::uint32_t bodies_begin = 0;  // into ConstraintGraph::island_bodies
    std::uint32_t bodies_end = 0;
    std::uint32_t blocks_begin = 0;  // into ConstraintGraph::island_blocks
    std::uint32_t blocks_end = 0;
};

struct ConstraintGraph {
    std::vector<SolverBody> bodies;  // sorted by id
    std::vector<RowBlock> blocks;    // sorted: see sort_blocks
    // Written by build_islands.
    std::vector<Island> islands;               // by their first body
    std::vector<std::uint32_t> island_bodies;  // ascending within an island: so by id
    std::vector<std::uint32_t> island_blocks;  // ascending within an island
    std::uint64_t revision = 0;                // grows with every build_islands

    std::span<const std::uint32_t> bodies_of(const Island& island) const {
        return std::span(island_bodies)
            .subspan(island.bodies_begin, island.bodies_end - island.bodies_begin);
    }
    std::span<const std::uint32_t> blocks_of(const Island& island) const {
        return std::span(island_blocks)
            .subspan(island.blocks_begin, island.blocks_end - island.blocks_begin);
    }

    // What the islands were built from: they stay as long as it does.
    std::vector<std::uint8_t> are_movable;                   // by body
    std::vector<std::array<std::uint32_t, 2>> block_bodies;  // by block: its bodies

    // Scratch of sort_blocks and build_islands.
    struct BlockPlace {
        std::uint64_t key = 0;
        std::uint32_t a = 0;
        std::uint32_t b = 0;
        std::uint32_t index = 0;
        RowKind kind = RowKind::contact;
    };
    std::vector<BlockPlace> places;
    std::vector<RowBlock> sorted_blocks;
    std::vector<std::uint32_t> parent;
    std::vector<std::uint32_t> island_of_root;
    std::vector<std::uint32_t> root_of_block;
};

// Index of the body with this id, or bodies.size(). Bodies are sorted by id.
std::size_t find_body(const ConstraintGraph& graph, std::uint64_t id);

// By the bodies' ids, then kind, then key: the order in which rows were found never shows.
void sort_blocks(ConstraintGraph& graph);

// Connected components over the bodies that any phase may move: everything but fixed ones. Bodies
// without a block have no island.
void build_islands(ConstraintGraph& graph);

// Indices of islands by their blocks, most first, of equal ones in order: threads that take them so
// wait least for each other.
void sort_largest_first(const ConstraintGraph& graph, std::span<std::uint32_t> islands);

// The worst error of each kind of row at the present poses, or a bound on it, metres.
struct IslandErrors {
    double drives_m = 0.0;
    double joints_m = 0.0;
    double contacts_m = 0.0;
    std::optional<JointError> joints;  // the joints' own, not a bound, where a solve has told it

    double without_drives_m() const { return std::max(joints_m, contacts_m); }
    double worst_m() const { return std::max(drives_m, without_drives_m()); }
};
IslandErrors island_errors(const ConstraintGraph& graph, const Island& island);

}  // namespace handhold

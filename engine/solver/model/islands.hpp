// Solver, model: the frame's constraint graph and its islands, that is, the sets of bodies that can
// push one another.

#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/solver/model/rows.hpp"

namespace handhold {

struct Island {
    std::uint32_t bodies_begin = 0;  // index into ConstraintGraph::island_bodies
    std::uint32_t bodies_end = 0;
    std::uint32_t blocks_begin = 0;  // index into ConstraintGraph::island_blocks
    std::uint32_t blocks_end = 0;
    bool is_heap = false;  // has more than k_max_direct_contacts contacts of loose bodies
};

// A loose body is a movable one that no joint and no drive holds. Islands with more contacts of
// loose bodies than this are solved by sweeps (sweeps/row_sweeps.hpp): contacts between loose
// bodies only to k_heap_slack_m, in bounded time. All else stays exact.
inline constexpr std::uint32_t k_max_direct_contacts = 48;
// Overlap at which a contact of two bodies of a heap counts as satisfied.
inline constexpr double k_heap_slack_m = 5e-5;

struct ConstraintGraph {
    std::vector<SolverBody> bodies;  // sorted by id
    std::vector<RowBlock> blocks;    // sorted: see sort_blocks
    // Written by build_islands.
    std::vector<Island> islands;  // ordered by their first body
    // Indices into `bodies`, island by island; ascending within an island, and hence sorted by
    // persistent id.
    std::vector<std::uint32_t> island_bodies;
    std::vector<std::uint32_t> island_blocks;  // ascending within an island
    std::uint64_t revision = 0;                // incremented by every build_islands

    std::span<const std::uint32_t> bodies_of(const Island& island) const {
        return std::span(island_bodies)
            .subspan(island.bodies_begin, island.bodies_end - island.bodies_begin);
    }
    std::span<const std::uint32_t> blocks_of(const Island& island) const {
        return std::span(island_blocks)
            .subspan(island.blocks_begin, island.blocks_end - island.blocks_begin);
    }

    // Topology the islands were built from; the islands are kept while it is unchanged.
    struct Tie {
        std::uint32_t a = 0;
        std::uint32_t b = 0;
        bool moves_a = false;
        bool moves_b = false;
        friend bool operator==(const Tie&, const Tie&) = default;
    };
    std::vector<Tie> ties;  // two bodies of each block

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
    std::vector<std::uint32_t> members;         // movable bodies with a block, ascending
    std::vector<std::uint8_t> is_member;        // indexed by body; all 0 between builds
    std::vector<std::uint32_t> parent;          // indexed by body; valid for members
    std::vector<std::uint32_t> island_of_root;  // indexed by body; valid for members
    std::vector<std::uint32_t> root_of_block;
};

// Index of the body with this id, or bodies.size() if there is none. Bodies must be sorted by id.
std::size_t find_body(const ConstraintGraph& graph, std::uint64_t id);

// Sorts blocks by their bodies' ids, then kind, then key. The order of detection has no effect on
// the result.
void sort_blocks(ConstraintGraph& graph);

// Finds connected components over all bodies that some phase may move (every role but `fixed`).
// Bodies without a block belong to no island. Also assigns SolverBody::slot and in_heap.
void build_islands(ConstraintGraph& graph);

// Sorts island indices by block count, largest first, ties by index. Threads that take islands in
// this order finish at about the same time.
void sort_largest_first(const ConstraintGraph& graph, std::span<std::uint32_t> islands);

// The largest error of each kind of block at the current poses, or an upper bound on it, metres.
struct IslandErrors {
    double drives_m = 0.0;
    double joints_m = 0.0;
    double contacts_m = 0.0;           // except those of heap_m
    double heap_m = 0.0;               // contacts of which only bodies of a heap move
    std::optional<JointError> joints;  // exact joint errors, if a solve has reported them

    double without_drives_m() const { return std::max(joints_m, contacts_m); }
    double worst_m() const { return std::max(drives_m, without_drives_m()); }
};
// True if all movable bodies of a contact are in a heap.
bool is_heap_contact(std::span<const SolverBody> bodies, const RowBlock& block);
IslandErrors island_errors(const ConstraintGraph& graph, const Island& island);

}  // namespace handhold

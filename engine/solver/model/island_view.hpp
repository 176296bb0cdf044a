// Solver, model: one island of the constraint graph, as a solve receives it.

#pragma once

#include <cstdint>
#include <limits>
#include <span>

#include "engine/solver/model/rows.hpp"

namespace handhold {

enum class BlockFilter : std::uint8_t { all, without_contacts, without_drives };
bool passes(BlockFilter filter, const RowBlock& block);

// A view of one island. Blocks between two bodies with zero inverse mass are skipped.
struct IslandView {
    BlockFilter filter = BlockFilter::all;
    std::span<SolverBody> bodies;  // bodies of the whole graph; indexed by island_bodies
    std::span<RowBlock> blocks;
    std::span<const std::uint32_t> island_bodies;
    std::span<const std::uint32_t> island_blocks;
    // Revision of the graph. While it is the same, so are islands and blocks. 0: unknown.
    std::uint64_t revision = 0;
    bool is_heap = false;  // Island::is_heap
    // Work that a solve may spend, in the unit of WorkBudget.
    std::uint64_t max_work = std::numeric_limits<std::uint64_t>::max();
};

// True if the filter includes the block and at least one of its bodies can move.
bool takes_part(const IslandView& island, const RowBlock& block);

}  // namespace handhold

#pragma once

#include <cstdint>
#include <span>

#include "engine/solver/model/rows.hpp"

namespace handhold {

enum class BlockFilter : std::uint8_t { all, without_contacts, without_drives };
bool passes(BlockFilter filter, const RowBlock& block);

// An island's part of the graph. Blocks between two bodies with zero inverse mass are passed over.
struct IslandView {
    BlockFilter filter = BlockFilter::all;
    std::span<SolverBody> bodies;  // of the whole graph
    std::span<RowBlock> blocks;
    std::span<const std::uint32_t> island_bodies;
    std::span<const std::uint32_t> island_blocks;
    std::uint64_t revision =
        0;  // the graph's: within one, islands and blocks are the same; 0: unknown
};

// True where the filter lets the block pass and something in it can move.
bool takes_part(const IslandView& island, const RowBlock& block);

}  // namespace handhold

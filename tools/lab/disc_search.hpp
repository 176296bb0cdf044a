#pragma once

#include <cstdint>
#include <span>

#include "engine/geometry/disc_trace.hpp"

// Baselines for find_crossing: the same search for a triangle that a disc cuts, in other orders.
namespace handhold::lab {

enum class SearchOrder : std::uint8_t {
    best_first,     // find_crossing itself: A*
    breadth_first,  // stops at the first hit or after k_max_pops visits, like find_crossing
    flood,          // visits everything in reach; finds the same triangle as breadth_first
};

// Like find_crossing, with the same contract, but in another search order.
CrossingSearch find_crossing_in(SearchOrder order, const SurfaceGraph& graph, const Disc& disc,
                                std::span<const GraphPoint> starts, TraceScratch& scratch);

}  // namespace handhold::lab

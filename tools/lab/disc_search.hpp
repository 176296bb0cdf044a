#pragma once

#include <cstdint>
#include <span>

#include "engine/geometry/disc_trace.hpp"

// Other orders of the search of a disc's cut, as baselines for find_crossing.
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

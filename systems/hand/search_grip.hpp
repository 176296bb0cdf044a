#pragma once

#include <span>
#include <vector>

#include "components/hand.hpp"
#include "components/hand_surroundings.hpp"
#include "components/stats.hpp"
#include "components/tuning.hpp"
#include "engine/ecs/column.hpp"

namespace handhold {

// How a palm's surface is chosen.
enum class GripSearch : std::uint8_t {
    smallest_sync,  // the surface of lowest full cost, see search_grip
    ray_only,       // the surface that the palm ray hits; for comparisons
};

struct SearchGripIo {
    std::span<const HandSurroundings> hands;  // in: body frame (_bs)
    // In/out: last frame's result, then this frame's; body frame (_bs).
    Column<GripSurface>& surface;
    GripSearchScratch& scratch;
};

// Chooses the surface under each gripping palm: the one for which the palm must move least from its
// tracked pose ("sync") to fit. Talk rows 2, 11, 17.
//
// 1. Search (shared/surface_search.hpp): a best-first search over neighbouring triangles within
//    PalmTuning::reach_m. Its seeds are the palm ray's hit, the nearest triangle and the triangle
//    of the last search. A triangle's closed-form cost is the palm's translation into the height
//    limits plus PalmTuning::tilt_cost_m_per_rad times its rotation into the tilt limit.
// 2. Evaluation (shared/surface_candidates.hpp): the palm is fitted to candidates in the order of
//    their closed-form costs, until no other candidate can be better.
//
// A hand searches when its grip begins, when its surroundings change, and after 3 cm of travel
// (hand_travel_m: 0.3 rad of turn). In other frames its surface is kept.
//
// A palm in an authored grip gets the nearest triangle, without a search. Talk row 10.
//
// Fallbacks counted: palm_no_surface (GripSurface::triangle is k_none).
void search_grip(const SearchGripIo& io, const Tuning& tuning, StageStats& stats,
                 GripSearch search = GripSearch::smallest_sync);

}  // namespace handhold

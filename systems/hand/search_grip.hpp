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
    smallest_sync,  // the surface that moves the palm least
    ray_only,       // the surface that the palm ray hits; for comparison
};

struct SearchGripIo {
    double dt_s = 0.0;  // in: length of the frame; infinity: no budget, evaluate all candidates
    std::span<const HandSurroundings> hands;  // in: body frame (_bs)
    Column<GripSurface>& surface;             // in/out: last frame's result seeds the search; _bs
    GripSearchScratch& scratch;
};

// Chooses the surface under each gripping palm: the one that needs the least palm movement
// ("sync"). Talk rows 2, 11, 17.
//
// 1. Search (shared/surface_search.hpp): best first over triangle neighbours, within
//    PalmTuning::reach_m, seeded at the palm ray's hit, the nearest triangle and last frame's
//    triangle. The cost in closed form is the palm translation into the height limits plus
//    PalmTuning::tilt_cost_m_per_rad times the rotation into the tilt limit.
// 2. Evaluation (shared/surface_candidates.hpp): candidates are fitted in the order of that cost
//    until none can be cheaper. The full cost is the movement of the fitted, depenetrated palm,
//    plus the remaining penetration of palm and fingers. Fingers without clearance are evaluated
//    once more as part of the palm's collision shape.
//
// Work is spread over frames: PalmTuning::evaluations_per_frame in every second frame. A chosen
// surface is followed for a few millimetres of travel before the next full search. A hand whose
// wrist and surroundings are unchanged keeps its result.
//
// A palm in an authored grip gets the nearest triangle without a search. Talk row 10.
//
// Fallbacks counted: palm_no_surface (GripSurface::triangle is k_none).
void search_grip(const SearchGripIo& io, const Tuning& tuning, StageStats& stats,
                 GripSearch search = GripSearch::smallest_sync);

}  // namespace handhold

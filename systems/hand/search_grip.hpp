#pragma once

#include <span>
#include <vector>

#include "components/hand.hpp"
#include "components/hand_surroundings.hpp"
#include "components/stats.hpp"
#include "components/tuning.hpp"
#include "engine/ecs/column.hpp"

namespace handhold {

inline constexpr double k_search_again_m = 0.03;  // travel after which a hand searches again

struct SearchGripIo {
    std::span<const HandSurroundings> hands;  // in: body frame (_bs)
    // In/out: last frame's result, then this frame's; body frame (_bs).
    Column<GripSurface>& surface;
    GripSearchScratch& scratch;  // scratch: nothing is read from an earlier call
};

// Chooses the surface under each gripping palm: the one for which the palm must move least from its
// tracked pose ("sync") to fit, with penalties for penetration and for backfaces. Talk rows 2, 11,
// 17.
//
// 1. Search (shared/surface_search.hpp): a best-first search over neighbouring triangles within
//    PalmTuning::reach_m. Its seeds are the palm ray's hit, the nearest triangle and the triangle
//    of the last search. A triangle's closed-form cost is the palm's translation into the height
//    limits plus PalmTuning::tilt_cost_m_per_rad times its rotation into the tilt limit, and for a
//    backface PalmTuning::backface_cost_m. Triangles at the back of the hand that face it are no
//    candidates.
// 2. Evaluation (shared/surface_candidates.hpp): the palm is fitted to candidates in the order of
//    their closed-form costs, while these are below the best full cost. At most
//    SurfaceCandidates::k_max_count are evaluated.
//
// A palm has no surface if none is near, or if the best one is inside a solid or out of the
// player's sight behind the gripped mesh at the time of the search (PalmFitter::is_out_of_sight):
// it is held where it is tracked, and fit_hands shows a fist on the player's side.
//
// A hand searches when its grip begins, when its surroundings have moved by about k_search_step_m,
// and after k_search_again_m of travel (hand_travel_m). In other frames it keeps what it found,
// also if that was no surface.
//
// A palm in an authored grip gets the triangle nearest to the authored palm within
// PalmTuning::reach_m, without a search. Talk row 10.
//
// Fallbacks counted: palm_no_surface, for each search that finds no surface (GripSurface::triangle
// is then k_none); not in authored grips.
void search_grip(const SearchGripIo& io, const Tuning& tuning, StageStats& stats);

}  // namespace handhold

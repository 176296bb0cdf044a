#pragma once

#include <span>
#include <vector>

#include "components/hand.hpp"
#include "components/hand_surroundings.hpp"
#include "components/stats.hpp"
#include "components/tuning.hpp"
#include "engine/ecs/column.hpp"

namespace handhold {

// Which surface the palm is held to where the ray's is not the only one.
enum class GripSearch : std::uint8_t {
    smallest_sync,  // the one that moves the palm least
    ray_only,       // where the palm's ray ends; for comparison
};

struct SearchGripIo {
    double dt_s = 0.0;                        // of the frame; infinity: all is tried at once
    std::span<const HandSurroundings> hands;  // in
    Column<GripSurface>& surface;             // in/out: last frame's is where the search begins too
    GripSearchScratch& scratch;
};

// Finds the triangle under each gripping palm that needs the least movement of the palm to meet its
// limits: best first over the surface's neighbours, from where the palm's ray ends, from the
// nearest triangle, and from last frame's. Moving the palm and tilting it are costs of one unit,
// PalmTuning::tilt_cost_m_per_rad apart. In the order of these costs surfaces are tried,
// PalmTuning::evaluations_per_frame in every second frame, until the others' are no less than the
// best one's (where that is not near, all around is looked at for one such turn, and listed): what
// counts then is the whole move that holds the palm there and pushes it out of what it is sunk in,
// and, where palm or fingers have no room however they bend, what stays sunk; such fingers are held
// clear with the palm where that costs less. A surface that is held is followed from its triangle
// for some millimetres before all around is searched again. Hands with nothing within
// PalmTuning::reach_m are left without a surface. Talk rows 2, 11, 17. Under a palm in an authored
// grip nothing is searched for: it has the nearest triangle.
void search_grip(const SearchGripIo& io, const Tuning& tuning, StageStats& stats,
                 GripSearch search = GripSearch::smallest_sync);

}  // namespace handhold

#pragma once

#include <array>
#include <vector>

#include "components/hand_surroundings.hpp"
#include "components/stats.hpp"
#include "engine/geometry/chain_fit.hpp"
#include "engine/math/penalty_quadratic.hpp"

namespace handhold {

// Data passed between the hand stages within one frame, and their scratch memory. Not state.
struct HandScratch {
    std::vector<HandSurroundings> surroundings;  // element i: hand i of the column HandOwner
    // Element i: hand i of the column HandOwner.
    std::vector<std::array<FingerTrace, k_finger_count>> traces;
    // Scratch memory of one slice of the hands. The hand stages process slices in parallel.
    struct Slice {
        StageStats stats;  // only fallbacks
        GripSearchScratch search;
        ChainFitScratch fit;
        std::vector<PenaltyRow> fit_rows;
    };
    std::vector<Slice> slices;
};

}  // namespace handhold

#pragma once

#include <array>
#include <vector>

#include "components/hand_surroundings.hpp"
#include "engine/geometry/chain_fit.hpp"

namespace handhold {

// What the stages of the hands hand on to each other within one frame, and what they work in. Not
// state.
struct HandScratch {
    std::vector<HandSurroundings> surroundings;                   // by row of HandOwner
    std::vector<std::array<FingerTrace, k_finger_count>> traces;  // the same; of this frame
    GripSearchScratch search;
    ChainFitScratch fit;
};

}  // namespace handhold

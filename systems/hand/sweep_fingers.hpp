#pragma once

#include <array>
#include <span>
#include <vector>

#include "components/hand.hpp"
#include "components/hand_surroundings.hpp"
#include "components/stats.hpp"
#include "components/tracking.hpp"
#include "components/tuning.hpp"
#include "engine/ecs/column.hpp"

namespace handhold {

struct SweepFingersIo {
    double dt_s = 0.0;                        // of the frame; infinity: shown is target at once
    std::span<const HandSurroundings> hands;  // in
    const Column<HandTracking>& hand;         // in: pressed
    const Column<GripSurface>& surface;       // in
    const Column<PalmPose>& palm;             // in
    Column<PalmOffset>& offset;               // in/out: lift_m
    Column<FingerPose>& fingers;              // in/out: all but thumbs
    std::span<std::array<FingerTrace, k_finger_count>> traces;  // out, by place in hands; may be
                                                                // empty
    ChainFitScratch& scratch;
};

// Closes the fingers of each gripping hand on what its palm is held to, and on whatever else is
// near: chain_fit.hpp says how, and of a hand that slides chain_refit.hpp and chain_follow.hpp.
// Hands that did not move on their surface by FingerTuning::reuse_travel_m keep their fingers.
// Where fingers stay sunk, the palm is lifted from the next frame on. Empty hands are at ease, or a
// fist where the player closes them. Talk rows 12 to 15. Fingers that an authored grip poses stand
// so, where they are not sunk there by more than FingerTuning::search_depth_m; the palm is not
// lifted then. Talk row 10.
void sweep_fingers(const SweepFingersIo& io, const Tuning& tuning, StageStats& stats,
                   SearchOrder order = SearchOrder::best_first);

}  // namespace handhold

#pragma once

#include <array>
#include <span>

#include "components/hand.hpp"
#include "components/hand_surroundings.hpp"
#include "components/stats.hpp"
#include "components/tracking.hpp"
#include "components/tuning.hpp"
#include "engine/ecs/column.hpp"

namespace handhold {

struct PoseThumbIo {
    double dt_s = 0.0;                        // of the frame; infinity: shown is target at once
    std::span<const HandSurroundings> hands;  // in
    const Column<HandTracking>& hand;         // in: pressed
    const Column<GripSurface>& surface;       // in
    Column<PalmOffset>& offset;               // in/out: lift_m
    Column<FingerPose>& fingers;              // in/out: thumbs only
    std::span<std::array<FingerTrace, k_finger_count>> traces;  // out, by place in hands; may be
                                                                // empty
    ChainFitScratch& scratch;
};

// Thumbs: no simple hinge, for the plane in which one bends turns about its base. A few angles of
// opposition are tried, each closed like a finger, and the cheapest stays: sunk little, touching,
// its tip near the surface, near to where a thumb rests. Comes after sweep_fingers and is solved
// where that was. Where it stays sunk, the palm is lifted from the next frame on. Talk row 15.
// A thumb that an authored grip poses stands so, where it is not sunk there. Talk row 10.
void pose_thumb(const PoseThumbIo& io, const Tuning& tuning, StageStats& stats,
                SearchOrder order = SearchOrder::best_first);

}  // namespace handhold

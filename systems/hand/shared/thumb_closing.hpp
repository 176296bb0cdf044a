#pragma once

#include "components/hand.hpp"
#include "components/hand_surroundings.hpp"
#include "components/tuning.hpp"
#include "engine/geometry/chain_fit.hpp"
#include "systems/hand/shared/digit_gaps.hpp"

// Closes a thumb, whose disc turns about its base by the opposition angle. Talk row 15.
namespace handhold {

struct ClosingThumb {
    const HandSurroundings& hand;
    const GripSurface& surface;
    const FingerRig& thumb;
    const Pose& wrist_bs;
    const DigitCapsules& fingers;  // closed before the thumb, in the frame of wrist_bs
};

struct ClosedThumb {
    double opposition_rad = 0.0;
    // The best fit. Its counters (discs, pops, walked) are sums over all oppositions.
    ChainFit fit;
    bool touches = false;  // a surface stops the thumb
};

// Closes the thumb like a finger at ThumbTuning::opposition_steps angles and returns the cheapest:
//   cost = penetration_cost * (depth + overlap with fingers)
//        + open_cost_m, if it touches nothing
//        + tip_gap_cost * tip gap
//        + opposition_cost_m_per_rad * |opposition - rest_opposition_rad|
// At each opposition, a thumb that crosses fingers is evaluated a second time, opened until it is
// clear of them. If costs are equal, the angle nearest to the rest pose wins.
ClosedThumb close_thumb(const ClosingThumb& closing, const ChainFitSettings& settings,
                        const ThumbTuning& tuning, ChainFitScratch& scratch);

// Opposition of the thumb's rest pose, within its limits.
double rest_opposition_rad(const FingerRig& thumb, const ThumbTuning& tuning);

}  // namespace handhold

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
    double dt_s = 0.0;  // in: length of the frame; infinity: no rate limit and no budget
    std::span<const HandSurroundings> hands;  // in: body frame (_bs)
    const Column<HandTracking>& hand;         // in: pressed
    const Column<GripSurface>& surface;       // in: body frame (_bs)
    Column<PalmOffset>& offset;               // in/out: lift_m, metres
    Column<FingerPose>& fingers;              // in/out: thumbs, radians; in: the fingers' solved_*
    std::span<std::array<FingerTrace, k_finger_count>>
        traces;  // out: by index in `hands`; or empty
    ChainFitScratch& scratch;
};

// Closes the thumb of each gripping hand at the cheapest opposition angle. Talk row 15.
//
// The thumb's disc turns about its base by the opposition angle. ThumbTuning::opposition_steps
// angles are each closed like a finger, a few per frame, and the cheapest is kept:
//   cost = penetration_cost * depth + open_cost_m (if it touches nothing) + tip_gap_cost * tip gap
//        + opposition_cost_m_per_rad * |opposition - rest_opposition_rad|
// Later frames keep the opposition while the thumb touches there without penetrating. Runs after
// sweep_fingers and uses the wrist for which the fingers were solved.
//
// A thumb that still penetrates raises the palm from the next frame on. A thumb with an authored
// pose takes it, unless it penetrates. Talk row 10.
//
// Fallbacks counted: finger_no_contact, palm_lifted, authored_finger_rejected.
void pose_thumb(const PoseThumbIo& io, const Tuning& tuning, StageStats& stats,
                SearchOrder order = SearchOrder::best_first);

}  // namespace handhold

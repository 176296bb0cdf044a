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
    // In/out: thumbs, radians; also reads solved_*, which sweep_fingers wrote.
    Column<FingerPose>& fingers;
    // Out: by index in `hands`; empty: not wanted.
    std::span<std::array<FingerTrace, k_finger_count>> traces;
    ChainFitScratch& scratch;
};

// Closes the thumb of each gripping hand at the cheapest opposition angle. Talk row 15.
//
// The opposition angle turns the thumb's disc about its base. At each of
// ThumbTuning::opposition_steps angles the thumb is closed like a finger, a few angles per frame.
// The angle of lowest cost is kept:
//   cost = penetration_cost * depth + open_cost_m (if it touches nothing) + tip_gap_cost * tip gap
//        + opposition_cost_m_per_rad * |opposition - rest_opposition_rad|
// Later frames keep this angle while the thumb touches the surface without penetrating. Runs after
// sweep_fingers and uses the wrist pose for which the fingers were solved.
//
// If the thumb still penetrates, the palm is raised from the next frame on. A thumb with an
// authored pose takes that pose, unless it penetrates there. Talk row 10.
//
// Fallbacks counted: finger_no_contact, palm_lifted, authored_finger_rejected.
void pose_thumb(const PoseThumbIo& io, const Tuning& tuning, StageStats& stats,
                SearchOrder order = SearchOrder::best_first);

}  // namespace handhold

#pragma once

#include <array>
#include <span>

#include "components/hand.hpp"
#include "components/hand_surroundings.hpp"
#include "components/stats.hpp"
#include "components/tuning.hpp"
#include "engine/ecs/column.hpp"

namespace handhold {

// Travel of the held wrist on the body after which a hand closes again: fingers may reach other
// parts.
inline constexpr double k_close_again_m = 0.08;

struct SweepFingersIo {
    std::span<const HandSurroundings> hands;  // in: body frame (_bs)
    const Column<GripSurface>& surface;       // in: body frame (_bs)
    const Column<PalmOffset>& offset;         // in: held_*, hand space, metres and radians
    // in/out: closed (radians), closed_*, touches, is_closed_*, is_authored,
    // authored_pose_rejected, is_newly_closed
    Column<FingerPose>& fingers;
    // out: by index in `hands`, written for hands that close in this frame; may be empty
    std::span<std::array<FingerTrace, k_finger_count>> traces;
    ChainFitScratch& scratch;  // scratch: nothing is read from an earlier call
};

// Closes all digits of a hand that begins to grip, until they touch the surfaces near it, with the
// palm where constrain_palms holds it. Talk rows 12 to 15. The result is where fit_hands starts: on
// which side of the surfaces each digit is, what it touches, and its angles.
//
// A finger closes from fully open, all hinges in step. Where a link first touches, its hinge and
// those before it stop and the links beyond close on (engine/geometry/chain_fit.hpp,
// disc_contact.hpp). The result is checked and depenetrated in three dimensions. A thumb closes at
// ThumbTuning::opposition_steps angles of opposition, of which the cheapest is kept
// (shared/thumb_closing.hpp).
//
// A hand closes again on another body, at another place of the surface (search_grip), when it
// enters or leaves an authored grip, after k_close_again_m of travel, and after a fit that has led
// into a solid (fit_hands). In an authored grip it closes again only if the authored wrist changes.
//
// Digits with an authored pose take it, unless it penetrates by more than
// FingerTuning::search_depth_m. Talk row 10. A hand without a surface does not close; digits with
// an authored pose then take it unchecked.
//
// Fallbacks counted: finger_full_search, finger_depenetrated, finger_opened, finger_no_contact,
// authored_finger_rejected.
void sweep_fingers(const SweepFingersIo& io, const Tuning& tuning, StageStats& stats);

}  // namespace handhold

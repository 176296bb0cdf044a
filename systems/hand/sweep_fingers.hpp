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
    double dt_s = 0.0;  // in: length of the frame; infinity: no rate limit and no budget
    std::span<const HandSurroundings> hands;  // in: body frame (_bs)
    const Column<HandTracking>& hand;         // in: pressed
    const Column<GripSurface>& surface;       // in: body frame (_bs)
    const Column<PalmPose>& palm;             // in: shown wrist, world space
    Column<PalmOffset>& offset;               // in/out: lift_m, metres
    Column<FingerPose>& fingers;              // in/out: all digits except thumbs, radians
    // Out: by index in `hands`; empty: not wanted.
    std::span<std::array<FingerTrace, k_finger_count>> traces;
    ChainFitScratch& scratch;
};

// Closes the fingers of each gripping hand until they touch the surfaces near it. Talk rows 12 to
// 15.
//
// A finger closes from fully open, all hinges by the same share of their range. When a link
// touches, its hinge and the hinges before it stop; the links beyond continue to close
// (engine/geometry/chain_fit.hpp, disc_contact.hpp). The result is checked and depenetrated in
// three dimensions. While a hand slides, each finger's last fit is updated (chain_refit.hpp,
// chain_follow.hpp). A finger that still penetrates is refitted from scratch, with a back-off
// (FingerBackoff). Angles are kept while the shown wrist travels less than
// FingerTuning::reuse_travel_m.
//
// If fingers still penetrate, PalmOffset::lift_m grows, which raises the palm from the next frame
// on. Fingers of an empty hand take the rest pose, or form a fist while the player presses the grab
// button.
//
// A finger with an authored pose takes that pose, unless it penetrates there by more than
// FingerTuning::search_depth_m. A palm in an authored grip is not lifted. Talk row 10.
//
// Fallbacks counted: finger_full_search, finger_depenetrated, finger_opened, finger_no_contact,
// palm_lifted, authored_finger_rejected.
void sweep_fingers(const SweepFingersIo& io, const Tuning& tuning, StageStats& stats,
                   SearchOrder order = SearchOrder::best_first);

}  // namespace handhold

#pragma once

#include <optional>
#include <span>
#include <vector>

#include "components/hand.hpp"
#include "components/hand_surroundings.hpp"
#include "components/stats.hpp"
#include "components/tracking.hpp"
#include "components/tuning.hpp"
#include "engine/ecs/column.hpp"
#include "engine/math/penalty_quadratic.hpp"
#include "systems/hand/shared/fit_terms.hpp"

namespace handhold {

// Hysteresis: a hand that closes again while it grips changes to the new closing if that costs less
// than this share of its last fit's cost.
inline constexpr double k_change_cost_share = 0.75;
// Travel of the tracked wrist up to which a fitted hand stays where it is on its surface.
inline constexpr double k_stick_m = 1e-3;

struct FitHandsIo {
    double dt_s;                              // in: length of the frame; infinity: no rate limit
    std::span<const HandSurroundings> hands;  // in: body frame (_bs)
    const Column<HandTracking>& hand;         // in: pressed, squeeze, trigger, curls
    const Column<GripSurface>& surface;       // in: body frame (_bs)
    Column<PalmOffset>& offset;               // in: held_*; in/out: target_*, shown_*, hand space
    Column<FingerPose>& fingers;              // in: closed, touches; in/out: target, shown, radians
    Column<PalmPose>& palm;                   // out: shown wrist, world space
};

// Fits wrist, fingers and thumb of each gripping hand together to the surfaces around it
// (shared/hand_fit.hpp), and shows all hands. Talk rows 10, 16 and 18.
//
// A hand that has just closed starts at the palm within its limits and the closed digits
// (constrain_palms, sweep_fingers). Other hands move on from last frame's fit, carried along with
// the tracked wrist; while that has travelled less than k_stick_m, the hand stays where it is on
// its body. A hand that closes again while it grips tries both and changes only if the closing
// costs less than k_change_cost_share of the other. The fit is kept while wrist and surroundings
// are unchanged and another one would change nothing.
//
// A palm in an authored grip keeps the authored wrist. Digits with an authored pose keep it, or
// move to their pressed pose with the trigger; other digits do not depend on the trigger. Fingers
// of an empty hand bend from the rest pose as far as the button is pressed that closes the hand,
// the index finger at least as far as the trigger; once the button counts as pressed the hand is a
// fist. A finger of known curl (HandTracking::curls) is bent as far as that, from straight to a
// fist.
//
// The shown hand follows at PalmTuning::rate_mps, FingerTuning::close_radps (closing) and
// open_radps (opening), all angles of a digit by the same share of their remaining change. Only the
// shown hand moves, never the player.
//
// Fallbacks counted: hand_penetrates, once per fit that started from a closing.
void fit_hands(const FitHandsIo& io, const Tuning& tuning, StageStats& stats);
// The same with scratch memory, so that warm frames do not allocate.
void fit_hands(const FitHandsIo& io, const Tuning& tuning, StageStats& stats,
               std::vector<PenaltyRow>& rows);

// Evaluates the objective of the hand as it is shown, term by term and digit by digit, for
// inspectors; frames do not compute this. Nullopt if the hand is on no surface.
std::optional<FitTerms> shown_fit_terms(const HandSurroundings& hand, const GripSurface& surface,
                                        const PalmOffset& offset, const FingerPose& pose,
                                        const PalmTuning& tuning);

}  // namespace handhold

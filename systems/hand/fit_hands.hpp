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
// Travel of the tracked wrist (hand_travel_m) since the last fit, below which a hand outside
// authored grips is not fitted again: it stays where it is on its body.
inline constexpr double k_stick_m = 1e-3;
// The shown palm covers large offsets faster than PalmTuning::rate_mps, the largest part of them
// within this time.
inline constexpr double k_palm_settle_s = 0.03;

struct FitHandsIo {
    double dt_s;                              // in: length of the frame; infinity: no rate limit
    std::span<const HandSurroundings> hands;  // in: body frame (_bs)
    const Column<HandTracking>& hand;         // in: pressed, squeeze, trigger, curls
    const Column<GripSurface>& surface;       // in: body frame (_bs)
    Column<PalmOffset>& offset;               // in: held_*; in/out: target_*, shown_*, hand space
    // in: results of sweep_fingers (closed, touches, is_closed_clear, is_authored); in/out:
    // is_newly_closed, closed_body, target, shown, is_clear, is_converged, thumbs_tried and
    // fitted_*; angles in radians
    Column<FingerPose>& fingers;
    Column<PalmPose>& palm;  // out: shown wrist, world space
};

// Fits wrist, fingers and thumb of each gripping hand together to the surfaces around it
// (shared/hand_fit.hpp), and shows all hands. Talk rows 10, 16 and 18.
//
// A hand that has just closed starts at the palm within its limits and the closed digits
// (constrain_palms, sweep_fingers). Other hands start at the last fit, carried along with the
// tracked wrist. A hand that closes again on the body that it grips is fitted from both starts and
// takes the closing only if its fit costs less than k_change_cost_share of the other. A hand whose
// fit from the last one has led into a solid closes again in the next frame, not twice in a row.
//
// In each of the k_thumb_tries fits after one from a closing, the thumb also starts at another
// opposition, outside authored grips; the hand takes it if it then costs clearly less.
//
// Then the last fit is kept without a new one while the surroundings are unchanged and the tracked
// wrist has travelled from the last fit by
//  - less than FingerTuning::reuse_travel_m, if that fit has converged;
//  - at least that, but less than k_stick_m, outside authored grips.
//
// A palm in an authored grip keeps the authored wrist. Digits with an authored pose keep it, or
// move to their pressed pose with the trigger; other digits do not depend on the trigger. A
// gripping hand without a surface is a fist. Fingers of an empty hand bend from the rest
// pose by HandTracking::squeeze, the index finger at least by the trigger; once the button counts
// as pressed the hand is a fist. A finger of known curl (HandTracking::curls) is bent as far as
// that, from straight to a fist.
//
// The shown hand follows at PalmTuning::rate_mps (faster if its palm is far off: k_palm_settle_s),
// FingerTuning::close_radps (closing) and open_radps (opening, and opposition), all angles of a
// digit by the same share of their remaining change. A gripping hand without a surface goes to the
// player's side of the surfaces around it, and on until it touches the gripped body, if that is
// within PalmTuning::reach_m and no other surface is between them (shared/outside_surfaces.hpp). A
// gripping hand on its way to a pose that is outside of surfaces (is_outside) is drawn outside at
// once. Authored grips do neither. Empty hands are drawn as tracked. Only the shown hand moves,
// never the player.
//
// Fallbacks counted: hand_penetrates, once per closing after which the fit still penetrates by
// millimetres.
void fit_hands(const FitHandsIo& io, const Tuning& tuning, StageStats& stats);
// The same with scratch memory in `rows`, so that warm frames do not allocate.
void fit_hands(const FitHandsIo& io, const Tuning& tuning, StageStats& stats,
               std::vector<PenaltyRow>& rows);

// Evaluates the objective of the hand as it is shown, term by term and digit by digit, for
// inspectors; frames do not compute this. Nullopt if the hand is on no surface.
std::optional<FitTerms> shown_fit_terms(const HandSurroundings& hand, const GripSurface& surface,
                                        const PalmPose& palm, const FingerPose& pose,
                                        const Tuning& tuning);

}  // namespace handhold

#pragma once

#include <optional>
#include <string>

#include "components/tuning.hpp"
#include "game/mesh/render_frame.hpp"
#include "systems/frame/frame.hpp"
#include "systems/hand/shared/fit_terms.hpp"

// Why a gripping hand is shaped as it is: the terms of its fit (systems/hand/shared/hand_fit.hpp).
namespace handhold {

// Terms of the shown hand, with the surroundings of the last frame. Nullopt if the hand is on no
// surface, and right after a restore.
std::optional<FitTerms> fit_terms_of(const World& world, const FrameCaches& caches,
                                     const Tuning& tuning, Entity hand);

// If a part's largest term costs less than this, no term shapes it. A palm that is 1 mm off costs
// this much.
inline constexpr double k_small_cost_m2 = 5e-7;

// The term that most shapes a part; nullopt if all are small.
std::optional<FitTerm> shaping_term(const FitTerms::Costs& cost_m2);
Color color_of(FitTerm term);  // same colour in gizmos and tables
inline constexpr Color k_at_ease = {0.75F, 0.75F, 0.8F};

const char* meaning_of(FitTerm term);  // ends a sentence that begins with a digit's name

}  // namespace handhold

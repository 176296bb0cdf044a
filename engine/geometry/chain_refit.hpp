#pragma once

#include <limits>
#include <optional>
#include <span>

#include "engine/geometry/chain_fit.hpp"

// Closes a chain again that was closed a moment ago and has moved little since: from the angles
// that it had. What is near the surface follows it by its gaps (chain_follow.hpp). Where that does
// not do, what is sunk opens until it is clear, and what is clear closes; where nothing is left to
// touch, it goes back to being relaxed. It stays with the one of several fits that it had: a chain
// that is closed anew takes whichever its way from fully open meets first, and may change between
// them from one moment to the next.
namespace handhold {

struct ChainRefitSettings {
    double touch_gap_m = 5e-4;    // a chain as near to the surface stays
    double touch_depth_m = 3e-4;  // or sunk as deep
    double query_gap_m = 2e-3;    // what is as near is followed by its gap
    double open_share = 0.02;     // at a time, of the way from open to closed
    std::int32_t open_steps = 3;
    double close_share = 0.06;  // what is so near is looked for first
    // Where it touches nothing: whether there is something to touch farther on, where that is known
    // from a moment ago. Else it is looked for (ChainFit::has_look_ahead).
    std::optional<bool> has_surface_ahead;
    // A hinge turns no farther, but where it opens out of something.
    double max_turn_rad = std::numeric_limits<double>::infinity();
};

// Never fails, but may be sunk deeper than fit_chain would be: then ChainFit::depth_m says so. A
// fit that touches nothing is ChainFallback::relaxed where there is nothing to touch.
// ChainFit::contact_triangle is none.
ChainFit refit_chain(const HingeChain& chain, const ChainAngles& last_rad,
                     std::span<const PlacedMesh> meshes, const ChainFitSettings& settings,
                     const ChainRefitSettings& refit, ChainFitScratch& scratch);

}  // namespace handhold

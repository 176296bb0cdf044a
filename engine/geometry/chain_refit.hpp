#pragma once

#include <limits>
#include <optional>
#include <span>

#include "engine/geometry/chain_fit.hpp"

// Refits a chain that was fitted a moment ago and moved little since, starting from its last
// angles. A chain near the surface follows its gaps (chain_follow.hpp). If that does not converge,
// a penetrating chain opens until it is clear, a clear chain closes, and a chain with nothing to
// touch returns to the rest pose. Where several fits are possible the chain keeps the one it had.
// Closing from fully open would take the first one in its path, and could alternate between them
// from frame to frame.
namespace handhold {

struct ChainRefitSettings {
    double touch_gap_m = 5e-4;    // with a smaller gap, the chain stays
    double touch_depth_m = 3e-4;  // and with a smaller penetration
    double query_gap_m = 2e-3;    // surfaces nearer than this are followed by their gap
    double open_share = 0.02;     // opening step, as a fraction of the range from open to closed
    std::int32_t open_steps = 3;
    double close_share = 0.06;  // closing looks for contact within this fraction of the range first
    // For a chain that touches nothing: whether a surface lies farther ahead, if the caller cached
    // the answer. None: queries it (ChainFit::has_look_ahead).
    std::optional<bool> has_surface_ahead;
    // Limit on each hinge's turn, except while it opens out of a penetration.
    double max_turn_rad = std::numeric_limits<double>::infinity();
};

// Never fails, but may leave a larger ChainFit::depth_m than fit_chain would. Returns
// ChainFallback::rest_pose if there is nothing to touch. ChainFit::contact_triangle is always none.
ChainFit refit_chain(const HingeChain& chain, const ChainAngles& last_rad,
                     std::span<const PlacedMesh> meshes, const ChainFitSettings& settings,
                     const ChainRefitSettings& refit, ChainFitScratch& scratch);

}  // namespace handhold

#pragma once

#include <limits>
#include <optional>
#include <span>

#include "engine/geometry/chain_fit.hpp"

// Refits a chain from its last angles, after it moved little. A chain near the surface follows its
// gaps (chain_follow.hpp). If following does not converge, a penetrating chain opens until it is
// clear, a clear chain closes, and a chain with nothing to touch returns to the rest pose. If
// several fits are possible, the chain keeps its last one. Closing from fully open would take the
// first fit in the chain's path, and could alternate between fits from frame to frame.
namespace handhold {

struct ChainRefitSettings {
    double touch_gap_m = 5e-4;    // a chain with a smaller gap touches
    double touch_depth_m = 3e-4;  // a chain with a larger depth must open
    double query_gap_m = 2e-3;    // surfaces with a smaller gap are followed (chain_follow.hpp)
    double open_share = 0.02;     // opening step, as a fraction of the range from open to closed
    std::int32_t open_steps = 3;
    double close_share = 0.06;  // fraction of the range in which closing first looks for contact
    // For a chain that touches nothing: the caller's cached answer to whether there is a surface
    // farther ahead. nullopt: queries it (ChainFit::has_look_ahead).
    std::optional<bool> has_surface_ahead;
    // Limit of each hinge's turn, except when the hinge opens out of a penetration.
    double max_turn_rad = std::numeric_limits<double>::infinity();
};

// May leave a larger ChainFit::depth_m than fit_chain would. Returns ChainFallback::rest_pose if
// there is nothing to touch. ChainFit::contact_triangle is always k_no_triangle.
ChainFit refit_chain(const HingeChain& chain, const ChainAngles& last_rad,
                     std::span<const PlacedMesh> meshes, const ChainFitSettings& settings,
                     const ChainRefitSettings& refit, ChainFitScratch& scratch);

}  // namespace handhold

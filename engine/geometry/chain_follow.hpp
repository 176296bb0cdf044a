#pragma once

#include <optional>

#include "engine/geometry/chain_patch.hpp"
#include "engine/geometry/hinge_chain.hpp"

// Keeps a chain in contact with a surface that moved a little. A Newton step on the gaps opens
// penetrating links and closes clear ones. Steps are repeated until all gaps are within tolerance.
// This takes two or three distance queries; closing from scratch also needs the cuts.
namespace handhold {

struct ChainFollowSettings {
    double touch_gap_m = 5e-4;    // a link with a smaller gap touches
    double touch_depth_m = 3e-4;  // deeper than this a link counts as penetrating
    double target_gap_m = 1e-4;   // gap that a Newton step aims for
    double query_gap_m = 2e-3;    // surfaces farther away are not queried
    // Limits of the total opening and closing, as fractions of the range from open to closed.
    // Everything that the chain can reach within them must have been gathered into the patch.
    double max_opening = 0.06;
    double max_closing = 0.06;
    int max_queries = 5;
};

struct FollowedChain {
    ChainAngles angle_rad = {};
    double depth_m = 0.0;                 // as ChainFit::depth_m
    std::int32_t last_touching_link = 0;  // the links beyond it are fully closed
};

// nullopt if it does not converge: no surface is near, opening within the limit does not clear the
// chain, or a free link would have to close farther than the queried distance. `depth`: result of
// chain_depth at `from_rad` with an extra radius of query_gap_m. The patch must contain all
// triangles that the links can reach within max_opening and max_closing.
std::optional<FollowedChain> follow_chain(const HingeChain& chain, const ChainAngles& from_rad,
                                          const ChainDepth& depth, ChainPatch& patch,
                                          const ChainFollowSettings& settings);

}  // namespace handhold

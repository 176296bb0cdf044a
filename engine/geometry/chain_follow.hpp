#pragma once

#include <optional>

#include "engine/geometry/chain_patch.hpp"
#include "engine/geometry/hinge_chain.hpp"

// Keeps a chain on a surface that has moved a little under it: what is sunk opens and what came
// clear closes, each by how fast its gap changes with the hinges, until all gaps are as they should
// be. Two or three looks at the surface do where closing anew needs its cuts as well.
namespace handhold {

struct ChainFollowSettings {
    double touch_gap_m = 5e-4;    // a link as near to the surface touches it
    double touch_depth_m = 3e-4;  // and is not sunk as deep as this
    double target_gap_m = 1e-4;   // what is moved is moved to this gap
    double query_gap_m = 2e-3;    // surfaces farther away are not seen
    // Of the way from open to closed, together: no hinge opens or closes farther. What the patch
    // was gathered for.
    double max_opening = 0.06;
    double max_closing = 0.06;
    int max_queries = 5;
};

struct FollowedChain {
    ChainAngles angle_rad = {};
    double depth_m = 0.0;                 // as ChainFit
    std::int32_t last_touching_link = 0;  // the last link that touches: beyond it all are closed
};

// Nothing where that does not do: nothing is near, more is sunk than opening helps, a link beyond
// the last that touches has farther to close than it sees. `depth` is of the chain at `from_rad`,
// query_gap_m thicker. The patch has what links come to within max_opening and max_closing.
std::optional<FollowedChain> follow_chain(const HingeChain& chain, const ChainAngles& from_rad,
                                          const ChainDepth& depth, ChainPatch& patch,
                                          const ChainFollowSettings& settings);

}  // namespace handhold

#pragma once

#include <cstdint>
#include <span>

#include "engine/geometry/chain_fit.hpp"
#include "engine/geometry/grip_mesh.hpp"
#include "engine/geometry/hinge_chain.hpp"

// Fingers as others close them: what sweep_fingers and pose_thumb are compared with. All of one
// call is in the mesh's frame.
namespace handhold::lab {

enum class FingerMethod : std::uint8_t {
    sweep,    // the runtime's
    talk,     // talk rows 12 to 14, and no more than they say
    spheres,  // spheres on the bones, moved in steps
};

struct ClosedFinger {
    ChainAngles angle_rad = {};
    std::int32_t contact_link = DiscClosure::k_none;  // the last that touches; none: relaxed
    std::uint32_t discs = 0;
    std::uint32_t pops = 0;  // triangles, as ChainFit counts them
    std::uint32_t walked = 0;
};

// One disc, in the finger's middle plane: the search to the first triangle that crosses it, the
// walk along the crossing edges, and for each joint in turn the highest contact.
// Where the search finds nothing, or nothing can be touched, the finger is relaxed.
ClosedFinger close_by_talk(const HingeChain& chain, const GripMesh& mesh,
                           const GraphPoint& seed_under_palm, SearchOrder order,
                           ChainFitScratch& scratch);

// The half of it that is flat. `line_ds`: the crossings of edges with the disc, in the walk's
// order. The finger is a line without thickness, straight beyond the joint that turns; contacts are
// the crossings within its reach, and where the line between two of them leaves the joint's disc.
// The one that the finger comes to first, of those within the joint's range, stops it; what lies
// between two crossings is not seen. Joints that meet nothing close fully.
ClosedFinger close_on_crossings(const HingeChain& chain, std::span<const Vec2> line_ds);

// From open to closed in 50 steps, all joints in step; two spheres a link, at its middle and its
// end, as thick as it. A link whose sphere would touch a triangle stops its joint and those before
// it where they are; those beyond go on. Nothing touched: relaxed.
ClosedFinger close_by_spheres(const HingeChain& chain, const GripMesh& mesh);

}  // namespace handhold::lab

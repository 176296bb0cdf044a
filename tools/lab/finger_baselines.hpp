#pragma once

#include <cstdint>
#include <span>

#include "engine/geometry/chain_fit.hpp"
#include "engine/geometry/grip_mesh.hpp"
#include "engine/geometry/hinge_chain.hpp"
#include "tools/lab/disc_search.hpp"

// Other methods of closing fingers, as baselines for sweep_fingers and fit_hands. All arguments of
// one call are in the mesh's frame.
namespace handhold::lab {

enum class FingerMethod : std::uint8_t {
    fit,      // method of the runtime
    closing,  // closing of the runtime without its fit
    talk,     // talk rows 12 to 14, taken literally
    spheres,  // spheres on the bones, moved in steps
};

struct ClosedFinger {
    ChainAngles angle_rad = {};
    // The last link that touches; k_none: rest pose.
    std::int32_t contact_link = DiscClosure::k_none;
    std::uint32_t discs = 0;
    std::uint32_t pops = 0;  // visited triangles, as ChainFit counts them
    std::uint32_t walked = 0;
};

// Uses one disc, in the finger's middle plane. Searches for the first triangle that crosses the
// disc, walks along the crossing edges, and takes the highest contact for each joint in turn.
// Returns the rest pose if the search finds nothing or nothing can be touched.
ClosedFinger close_by_talk(const HingeChain& chain, const GripMesh& mesh,
                           const GraphPoint& seed_under_palm, SearchOrder order,
                           ChainFitScratch& scratch);

// The planar part of close_by_talk. `line_ds`: crossings of edges with the disc, in the walk's
// order. The finger is a line without thickness, straight beyond the joint that turns. Its contacts
// are the crossings within reach, and the points where the line between two crossings leaves the
// joint's disc. The first contact within the joint's range stops the joint; the surface between two
// crossings is ignored. Joints without contact close fully.
ClosedFinger close_on_crossings(const HingeChain& chain, std::span<const Vec2> line_ds);

// Closes all joints in 50 equal steps, with two spheres per link (at its middle and its end, with
// the link's radius). A link whose sphere would touch a triangle stops its own joint and the
// earlier ones; later joints continue. Returns the rest pose if nothing is touched.
ClosedFinger close_by_spheres(const HingeChain& chain, const GripMesh& mesh);

}  // namespace handhold::lab

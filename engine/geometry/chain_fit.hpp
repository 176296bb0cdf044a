#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/geometry/chain_patch.hpp"
#include "engine/geometry/disc_contact.hpp"
#include "engine/geometry/disc_trace.hpp"
#include "engine/geometry/hinge_chain.hpp"
#include "engine/math/math.hpp"

// Closes a chain of hinged capsules over meshes until it touches them.
//
// Three planes cut the meshes: the chain's own and one on each side, where its capsules are
// thinner; in each a search over the surface finds the cut (disc_trace.hpp), and in all of them at
// once the chain closes (disc_contact.hpp). What came out is looked at in space, over all that the
// chain can come to (chain_patch.hpp), and mended where it is sunk: the planes see neither what
// lies between them nor a second surface that no neighbour leads to.
// All of one call is in one frame, metres and radians. Sources: talk rows 12 to 15.
namespace handhold {

// Where the searches begin, all at once, on the first mesh's search detail, in that mesh's frame;
// what has no triangle is no start. With none at all every cut is looked for.
using ChainSeed = std::array<GraphPoint, 2>;

struct ChainFitSettings {
    double plane_offset = 0.62;      // of the outer planes from the middle one, in mean link radii
    double search_depth_m = 1.2e-3;  // sunk deeper: all cuts are looked for
    double open_depth_m = 8e-4;      // still sunk deeper: opened
    double open_step_rad = 0.0436;   // at a time
    std::int32_t open_steps = 6;
    SearchOrder order = SearchOrder::best_first;
    // Of several bends that are clear the one nearest to this is taken; none: to the relaxed pose,
    // which comes first in any case where no bend touches.
    std::optional<ChainAngles> near_rad;
    bool recloses_to_touch =
        true;              // of what is bent clear and touches nothing there: until it touches
    bool searches = true;  // false: all cuts at once, none is searched for, and what is sunk before
                           // it closes is not closed from there: cheap
    bool depenetrates = true;  // false: neither bends nor opens what is sunk
};

enum class ChainFallback : std::uint8_t {
    none,
    all_cuts,     // the cuts that neighbours lead to did not do: all that a tree finds
    rest_pose,    // nothing to touch
    sample_pose,  // sunk where it is straight, or as it closes from there: bent until it is clear,
                  // or sunk least; it may touch nothing then
    opened,       // and still sunk: opened a little
};

struct ChainFit {
    std::array<double, k_max_disc_links> angle_rad = {};
    // The last that touches; of what is bent or opened, the deepest. None where nothing is touched,
    // and of what is relaxed, sunk or not.
    std::int32_t contact_link = DiscClosure::k_none;
    std::uint32_t contact_triangle =
        k_no_triangle;     // of the first mesh's search detail, where the
                           // middle plane's search ended: next time's seed
    double depth_m = 0.0;  // how deep the deepest link is sunk, at least 0; where a surface goes
                           // through the chain's middle, with what is beyond
    ChainFallback fallback = ChainFallback::none;
    bool is_turn_limited =
        false;                    // of a refit (chain_refit.hpp): it would turn farther than it may
    bool has_look_ahead = false;  // of a refit: there was nothing to touch near it
    bool has_surface_ahead = false;    // then: and there is farther on
    bool needs_depenetration = false;  // only where ChainFitSettings::mends is off: with it, it
                                       // would be another
    std::uint32_t discs = 0;           // planes searched
    std::uint32_t pops = 0;            // triangles that the searches looked at
    std::uint32_t walked = 0;  // triangles that the walks passed, and those searched between the
                               // search detail and the surface itself
};

// Keeps its memory between calls.
struct ChainFitScratch {
    ChainPatch patch;
    TraceScratch trace;
    DiscScratch disc;
    std::vector<DiscSegment> cuts;  // all of the patch's
    std::vector<DiscSegment> segments;
};

// Never fails: where nothing fits, the fit that is sunk least. `meshes` may be empty.
ChainFit fit_chain(const HingeChain& chain, std::span<const PlacedMesh> meshes,
                   const ChainSeed& seed, const ChainFitSettings& settings,
                   ChainFitScratch& scratch);

// Of one capsule anywhere: what fit_chain asks its patch, from the beginning. Gathers and allocates
// anew: for tests and tools.
CapsulePenetration find_penetration(const Capsule& capsule, std::span<const PlacedMesh> meshes);

}  // namespace handhold

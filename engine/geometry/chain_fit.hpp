#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/geometry/chain_patch.hpp"
#include "engine/geometry/disc_contact.hpp"
#include "engine/geometry/disc_trace.hpp"
#include "engine/geometry/hinge_chain.hpp"
#include "engine/math/math.hpp"

// Closes a chain of hinged capsules over meshes until it touches them.
//
// Three parallel planes cut the meshes: the chain's own and one on each side of it, where the
// capsules' cross-sections are thinner. A graph search finds the cut in each plane
// (disc_trace.hpp), and the chain closes against all cuts at once (disc_contact.hpp). The result is
// then checked in 3D against every triangle in reach (chain_patch.hpp) and depenetrated: the planes
// miss geometry between them and surfaces that the graph does not connect to the seed.
// All positions of one call are in one frame. Sources: talk rows 12 to 15.
namespace handhold {

// Start points of the graph search, on the first mesh's search detail and in that mesh's frame. A
// point without a triangle is ignored. With no start point at all, every cut is used.
using ChainSeed = std::array<GraphPoint, 2>;

// Lengths and angles have no defaults of their own: 0 switches a step off or tolerates nothing. The
// runtime takes them from the tuning.
struct ChainFitSettings {
    double plane_offset = 0.0;    // outer planes' offset from the middle one, in mean link radii
    double search_depth_m = 0.0;  // a deeper fit uses all cuts, then the sample poses
    double open_depth_m = 0.0;    // sample poses up to this depth count as clear; deeper fits open
    double open_step_rad = 0.0;   // opening step of each hinge
    std::int32_t open_steps = 0;  // maximum number of opening steps
    SearchOrder order = SearchOrder::best_first;
    bool depenetrates = true;  // false: leaves a penetrating fit as it is
};

enum class ChainFallback : std::uint8_t {
    none,
    all_cuts,   // the graph search's cuts did not suffice: used every cut in reach
    rest_pose,  // nothing to touch
    // The closed chain penetrated: uses the sample pose that is clear or penetrates least. It may
    // touch nothing.
    sample_pose,
    opened,  // still penetrating after that: opened stepwise
};

struct ChainFit {
    std::array<double, k_max_disc_links> angle_rad = {};
    // Last link that touches; after depenetration, the deepest link. k_none if nothing is touched,
    // and always for the rest pose.
    std::int32_t contact_link = DiscClosure::k_none;
    // Triangle of the first mesh's search detail where the middle plane's search ended: the seed of
    // the next fit.
    std::uint32_t contact_triangle = k_no_triangle;
    // Penetration of the deepest link, >= 0. Includes the chain beyond a surface that crosses its
    // axis.
    double depth_m = 0.0;
    ChainFallback fallback = ChainFallback::none;
    // Only with ChainFitSettings::depenetrates off: the fit would have been depenetrated.
    bool needs_depenetration = false;
    std::uint32_t discs = 0;   // planes searched
    std::uint32_t pops = 0;    // triangles popped by the graph searches
    std::uint32_t walked = 0;  // triangles visited on the contact detail
};

// Working memory, reused between calls.
struct ChainFitScratch {
    ChainPatch patch;
    TraceScratch trace;
    DiscScratch disc;
    std::vector<DiscSegment> cuts;  // all cuts within reach, from the patch
    std::vector<DiscSegment> segments;
};

// Never fails: if no pose is clear, returns the one that penetrates least. `meshes` may be empty.
ChainFit fit_chain(const HingeChain& chain, std::span<const PlacedMesh> meshes,
                   const ChainSeed& seed, const ChainFitSettings& settings,
                   ChainFitScratch& scratch);

// Penetration of a single capsule, as fit_chain computes it. Gathers and allocates on every call:
// for tests and tools.
CapsulePenetration find_penetration(const Capsule& capsule, std::span<const PlacedMesh> meshes);

}  // namespace handhold

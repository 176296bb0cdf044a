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
// then checked in 3D against every triangle in reach (chain_patch.hpp) and depenetrated, because
// the planes miss two kinds of surfaces: those between the planes, and those that the graph does
// not connect to the seed. All positions of one call are in one frame. Sources: talk rows 12 to 15.
namespace handhold {

// Start points of the graph search, on the first mesh's search detail and in that mesh's frame. A
// point without a triangle is ignored. If no point has a triangle, all cuts are used.
using ChainSeed = std::array<GraphPoint, 2>;

// Lengths and angles default to 0, which turns a step off or allows no penetration. The runtime
// sets them from the tuning.
struct ChainFitSettings {
    double plane_offset = 0.0;  // outer planes' offset from the middle one, in mean link radii
    // If a fit penetrates deeper than this, it is repeated with all cuts in reach. If that
    // penetrates deeper too, a sample pose replaces it.
    double search_depth_m = 0.0;
    // A sample pose that penetrates at most this deep counts as clear. A fit that penetrates deeper
    // than this in the end is opened step by step.
    double open_depth_m = 0.0;
    double open_step_rad = 0.0;   // opening step of each hinge
    std::int32_t open_steps = 0;  // maximum number of opening steps
    bool depenetrates = true;     // false: leaves a penetrating fit as it is
};

enum class ChainFallback : std::uint8_t {
    none,
    all_cuts,   // the cuts that the graph search found did not suffice: used all cuts in reach
    rest_pose,  // the closing chain touches nothing: used the rest pose
    // The closed chain penetrated: used a clear sample pose, or the one that penetrates least. It
    // may touch nothing.
    sample_pose,
    opened,  // the closed chain or its sample pose penetrated: opened step by step
};

struct ChainFit {
    std::array<double, k_max_disc_links> angle_rad = {};
    // Last link that touches; after depenetration, the deepest link. k_none if nothing is touched,
    // and always for the rest pose.
    std::int32_t contact_link = DiscClosure::k_none;
    // Penetration of the deepest link, >= 0. If a surface crosses a link's axis, the chain beyond
    // the crossing counts as penetrating.
    double depth_m = 0.0;
    ChainFallback fallback = ChainFallback::none;
    // Only if ChainFitSettings::depenetrates is false: the fit penetrates so deep that it would
    // otherwise have been replaced by a sample pose or opened.
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
    // Segments in which the chain's planes cut the gathered triangles of `patch`.
    std::vector<DiscSegment> cuts;
    std::vector<DiscSegment> segments;
};

// Closes the chain over the meshes. If no pose is clear, returns the one that penetrates least.
// `meshes` may be empty.
ChainFit fit_chain(const HingeChain& chain, std::span<const PlacedMesh> meshes,
                   const ChainSeed& seed, const ChainFitSettings& settings,
                   ChainFitScratch& scratch);

// Penetration of a single capsule, computed like in fit_chain. Gathers and allocates on every call:
// for tests and tools.
CapsulePenetration find_penetration(const Capsule& capsule, std::span<const PlacedMesh> meshes);

}  // namespace handhold

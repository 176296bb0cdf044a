// Solver, contact: refreshes contacts at the poses a solve ended with.

#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/collision/collision_world.hpp"
#include "engine/solver/model/islands.hpp"

namespace handhold {

// Penetration depth above which a new contact counts as overlapping. Bullet's noise is smaller.
inline constexpr double k_new_overlap_m = 2e-5;

struct MovingContacts {
    CollisionWorld& collision;
    // In/out: one per body of graph.bodies, except the world's body, which is the last; they follow
    // the bodies.
    std::vector<ColliderProxy>& proxies;
    std::vector<ContactPoint>& contacts;  // in/out; sorted by pair and feature
    ConstraintGraph& graph;               // out: contact blocks, islands
    std::vector<ContactPoint>& scratch;   // scratch; afterwards the old contacts that were kept
    std::vector<ColliderProxy>& updates;  // scratch: proxies to send to the collision world
    // Bodies outside all islands that may also have moved. If there are any, contacts are searched
    // again in any case.
    std::span<const std::uint32_t> also_moved = {};
    // Out, appended: impacts that stopped a motion and whose points were then replaced. Null: not
    // reported.
    std::vector<ContactPoint>* impacts = nullptr;
};

// Treatment of a pair's old contact points when new ones are found.
enum class OldPoints : std::uint8_t {
    replaced,
    // Old points from which the bodies have not slid apart are kept beside the new ones. A round
    // edge that rolls from one point to the next needs all of them.
    kept,
};

enum class FoundContacts : std::uint8_t { unchanged, clear, overlapping };

// Finds contacts by sweeping colliders from their last valid poses to the solver's current poses,
// makes them the graph's contact blocks and rebuilds the islands. Tests only the bodies of islands
// and also_moved; the other bodies do not move and cost nothing. If also_moved is empty and no
// collider moved, returns `unchanged` and does nothing.
FoundContacts refresh_contacts(const MovingContacts& moving, const ContactLimits& limits,
                               OldPoints old_points);

// Adds `impacts` to the contacts for the velocity solve, and rebuilds contact blocks and islands.
// Needed if a body hits a round edge off centre: the position solve slides the body along the plane
// of the impact, and the sweep to the solved pose then meets the edge later, where the normal is
// nearly perpendicular to the velocity. Only the normal at the time of the impact reverses the
// velocity. The added contacts have separation 0 at the bodies' current poses.
void restore_impacts(const MovingContacts& moving, std::span<const ContactPoint> impacts);

}  // namespace handhold

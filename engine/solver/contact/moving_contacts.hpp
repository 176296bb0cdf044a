// Solver, contact: refreshes contacts at the poses a solve ended with.

#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/collision/collision_world.hpp"
#include "engine/solver/model/islands.hpp"

namespace handhold {

// Penetration depth above which a new contact counts as overlapping; Bullet's noise is below.
inline constexpr double k_new_overlap_m = 2e-5;

struct MovingContacts {
    CollisionWorld& collision;
    // In/out: one per body of graph.bodies, except the world; follow the bodies.
    std::vector<ColliderProxy>& proxies;
    std::vector<ContactPoint>& contacts;  // in/out; sorted by pair and feature
    ConstraintGraph& graph;               // out: contact blocks, islands
    std::vector<ContactPoint>& scratch;   // scratch; afterwards the previous contacts
    std::vector<ColliderProxy>& updates;  // scratch: proxies to send to the collision world
    // Bodies outside all islands that may also have moved. If there are any, contacts are searched
    // again in any case.
    std::span<const std::uint32_t> also_moved = {};
    // Out, appended: impacts that stopped a motion and whose points were then replaced. Null: not
    // wanted.
    std::vector<ContactPoint>* impacts = nullptr;
};

// What happens to the old contact points of a pair for which new ones are found.
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

// Adds `impacts` to the contacts, for the velocity solve: where a body hits a round edge off its
// centre, the solve takes it along the plane of the impact, and a sweep to where it is then meets
// the edge later, where the normal is nearly across its velocity. The impact's normal, at the time
// of impact, is what reverses the velocity. Each is added at the bodies' present poses, as
// touching.
void restore_impacts(const MovingContacts& moving, std::span<const ContactPoint> impacts);

}  // namespace handhold

#pragma once

#include <cstdint>
#include <vector>

#include "engine/collision/collision_world.hpp"
#include "engine/solver/model/islands.hpp"

// Contacts that are found again where a solve left the bodies.
namespace handhold {

// A contact found on a solve's result counts as overlap from here: Bullet's own noise is below.
inline constexpr double k_new_overlap_m = 2e-5;

struct MovingContacts {
    CollisionWorld& collision;
    std::vector<ColliderProxy>& proxies;  // as graph.bodies, but for the world; follow them
    std::vector<ContactPoint>& contacts;  // in/out, sorted by pair and feature
    ConstraintGraph& graph;               // out: contact rows, islands
    std::vector<ContactPoint>& scratch;   // the contacts before, when done
};

// What becomes of points found before, of a pair that is found again.
enum class OldPoints : std::uint8_t {
    replaced,
    kept,  // those that the bodies have not slid away from: a round edge that rolls from one point
           // to the next is met by all of them
};

enum class FoundContacts : std::uint8_t { unchanged, clear, overlapping };

// Sweeps colliders from their last valid pose to where the solver's bodies are now, and makes the
// contacts found there the graph's rows; islands are built anew. As before, and nothing done, where
// no collider moved.
FoundContacts refresh_contacts(const MovingContacts& moving, const ContactLimits& limits,
                               OldPoints old_points);

}  // namespace handhold

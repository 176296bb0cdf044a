// Solver, contact: turns contact points into constraint blocks.

#pragma once

#include <span>

#include "engine/collision/collision_world.hpp"
#include "engine/solver/model/islands.hpp"

namespace handhold {

// Replaces the graph's contact blocks by those of `contacts` and rebuilds the islands. Every id
// must be in graph.bodies, else PreconditionError.
void replace_contact_rows(std::span<const ContactPoint> contacts, ConstraintGraph& graph);

}  // namespace handhold

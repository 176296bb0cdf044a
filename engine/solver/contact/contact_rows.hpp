#pragma once

#include <span>

#include "engine/collision/collision_world.hpp"
#include "engine/solver/model/islands.hpp"

namespace handhold {

// Replaces the graph's contact rows by those of `contacts` and finds the islands again. Every id
// must be one of graph.bodies (PreconditionError).
void replace_contact_rows(std::span<const ContactPoint> contacts, ConstraintGraph& graph);

}  // namespace handhold

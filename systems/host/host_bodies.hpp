#pragma once

#include "systems/host/host_world.hpp"

// Bodies as the C interface defines and changes them. Each function throws HostError for what it
// refuses.
namespace handhold {

// Refuses a mesh: dynamic bodies need solid shapes.
void require_solid(const hh_world& host, ShapeId shape);
// The shape of the body's collider; k_no_shape if it has none.
ShapeId shape_id_of(const hh_world& host, Entity body);
// The body that the definition describes, with this shape. An inertia of zero is computed from the
// solid shape.
RigidBody rigid_body_of(const hh_world& host, const hh_body_def& def, ShapeId shape);
// The entity of a body. Refuses bodies that are not dynamic.
Entity dynamic_body_of(const hh_world& host, hh_body body);

}  // namespace handhold

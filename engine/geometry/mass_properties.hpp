#pragma once

#include "engine/geometry/shape_library.hpp"

// Volume, centre of mass and inertia of solids.
namespace handhold {

// The density is uniform, except that the parts of a compound may have their own masses.
struct MassProperties {
    double volume_m3 = 0.0;
    Vec3 centre_m = Vec3::Zero();  // centre of mass, in the shape's frame
    // Per kg of total mass; about the centre of mass, along the shape's axes.
    Mat3 inertia_per_kg_m2 = Mat3::Zero();
};

// Exact: closed forms, or for a hull a sum over its faces. Volume in which parts of a compound
// overlap counts once per part. Throws PreconditionError for meshes, which have no inside.
MassProperties mass_properties(const Shape& shape);

// Frame at the centre of mass along the principal axes, in the shape's frame. The order and the
// signs of the axes keep the rotation from the shape's axes small.
Pose principal_frame(const MassProperties& properties);

}  // namespace handhold

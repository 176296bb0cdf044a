#pragma once

#include "engine/collision/shape_library.hpp"

// Volume, centre of mass and inertia of solids.
namespace handhold {

// For uniform density, or for a compound's own masses if it has any.
struct MassProperties {
    double volume_m3 = 0.0;
    Vec3 centre_m = Vec3::Zero();  // centre of mass, in the shape's frame
    // Per kg of total mass; about the centre of mass, along the shape's axes.
    Mat3 inertia_per_kg_m2 = Mat3::Zero();
};

// Exact: closed forms, and for a hull a sum over its faces. The overlap of a compound's parts
// counts twice. Throws PreconditionError for meshes, which have no inside.
MassProperties mass_properties(const Shape& shape);

// The frame at the centre of mass along principal axes, given in the shape's frame. The order and
// signs of the axes are chosen for the smallest rotation from the shape's own.
Pose principal_frame(const MassProperties& properties);

}  // namespace handhold

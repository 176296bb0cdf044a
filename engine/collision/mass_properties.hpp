#pragma once

#include "engine/collision/shape_library.hpp"

// Where the mass of a solid is.
namespace handhold {

// Of the solid of uniform density; of a compound with masses of its own, of those.
struct MassProperties {
    double volume_m3 = 0.0;
    Vec3 centre_m = Vec3::Zero();           // of mass, in the shape's frame
    Mat3 inertia_per_kg_m2 = Mat3::Zero();  // about the centre of mass, along the shape's axes
};

// Exact: closed forms, and of a hull the sum over its faces. Parts of a compound that overlap
// count twice where they do. Not for meshes (PreconditionError): they have no inside.
MassProperties mass_properties(const Shape& shape);

// The frame at the centre of mass along principal axes, in the shape's frame: of all such frames
// the one whose axes are nearest to the shape's own.
Pose principal_frame(const MassProperties& properties);

}  // namespace handhold

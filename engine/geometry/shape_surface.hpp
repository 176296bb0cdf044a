#pragma once

#include "engine/collision/shape_library.hpp"
#include "engine/geometry/mesh.hpp"

namespace handhold {

// A shape's surface as triangles in the shape's frame, counter-clockwise seen from outside (meshes
// as they are wound). Corners lie on the true surface, and no point of the triangles is farther
// from it than tolerance_m (> 0) but on round shapes so large that they would need more than
// k_max_sectors around: those deviate by at most 8e-5 (sphere, capsule: 1.6e-4) of their radius.
// Parts of a compound stay whole where they overlap: what is inside of another part stays there.
// Of a mesh triangle i is triangle i.
Mesh shape_surface(const Shape& shape, double tolerance_m);

inline constexpr std::uint32_t k_max_sectors = 256;

}  // namespace handhold

#pragma once

#include "engine/geometry/mesh.hpp"
#include "engine/geometry/shape_library.hpp"

namespace handhold {

// A shape's surface as triangles in the shape's frame, counter-clockwise seen from outside. Meshes
// keep their winding and triangle order. Corners lie on the true surface, and no point is farther
// from it than tolerance_m (> 0). Round shapes that would need more than k_max_sectors sectors per
// turn deviate by at most 8e-5 of their radius (sphere, capsule: 1.6e-4). Overlapping parts of a
// compound are kept whole, including the surfaces inside other parts.
Mesh shape_surface(const Shape& shape, double tolerance_m);

inline constexpr std::uint32_t k_max_sectors = 256;

}  // namespace handhold

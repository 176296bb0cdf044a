#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "engine/geometry/mesh.hpp"

namespace handhold {

// How a run of vertex indices is cut into triangles (glTF 2.0 specification, 3.7.2.1).
enum class TriangleMode { list, strip, fan };
enum class Winding { kept, reversed };

// How many triangles `corners` indices make; none where they are too few or, for a list, no
// multiple of three.
std::size_t count_triangles(TriangleMode mode, std::size_t corners);

// Appends the triangles of `indices` to the mesh and returns how many of them were dropped because
// they have no area: a corner twice, or three corners on a line up to rounding. The caller
// guarantees that first + index is a position of the mesh for every index.
std::size_t append_triangles(TriangleMode mode, Winding winding,
                             std::span<const std::uint32_t> indices, std::uint32_t first,
                             Mesh& mesh);

}  // namespace handhold

#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "engine/geometry/mesh.hpp"

namespace handhold {

// How a list of vertex indices forms triangles (glTF 2.0 specification, 3.7.2.1).
enum class TriangleMode { list, strip, fan };
enum class Winding { kept, reversed };

// The number of triangles that `corners` indices form; 0 if there are too few or, for a list, if
// their number is not a multiple of three.
std::size_t count_triangles(TriangleMode mode, std::size_t corners);

// Appends the triangles of `indices` to the mesh. Adds `first` to each index. Leaves out triangles
// without area (two equal corners, or three corners on a line up to rounding) and returns their
// number. Precondition: first + index is below the number of positions for every index.
std::size_t append_triangles(TriangleMode mode, Winding winding,
                             std::span<const std::uint32_t> indices, std::uint32_t first,
                             Mesh& mesh);

}  // namespace handhold

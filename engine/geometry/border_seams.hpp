#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "engine/geometry/surface_graph.hpp"

// Closes seams between open borders that coincide within WeldLimits. Nearby border vertices are
// merged, and a border edge is split at another border's vertex that lies on it (a T-junction).
// Both functions change only positions, triangles, source_triangle and the report's counts.
namespace handhold {

// Merges nearby vertices of open borders into their centroid. May leave degenerate or duplicate
// triangles.
void sew_borders(SurfaceGraph& graph, const WeldLimits& limits);

// Splits triangles at border vertices that lie on their open edges.
void cut_borders(SurfaceGraph& graph, const WeldLimits& limits);

}  // namespace handhold

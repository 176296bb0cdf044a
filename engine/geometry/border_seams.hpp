#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "engine/geometry/surface_graph.hpp"

// Open borders that lie on each other become one edge: vertices that are near are joined, and a
// border is cut where another border's vertex lies on it (a T-junction). Works on a graph's
// positions, triangles and source_triangle only, and counts in its report. What is near:
// WeldLimits.
namespace handhold {

// Joins vertices of open borders; each comes to lie in the middle of those that it was. May leave
// triangles without area, with a corner twice, or twice the same.
void sew_borders(SurfaceGraph& graph, const WeldLimits& limits);

// Cuts triangles at vertices on their open edges into triangles that have those as corners.
void cut_borders(SurfaceGraph& graph, const WeldLimits& limits);

}  // namespace handhold

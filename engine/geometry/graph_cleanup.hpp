#pragma once

#include "engine/geometry/surface_graph.hpp"

// Drops what is no triangle, or is there already; counts in the report. Works on triangles and
// source_triangle only: who calls links again.
namespace handhold {

void drop_not_finite(SurfaceGraph& graph);  // a corner is NaN or infinite
void drop_degenerate(SurfaceGraph& graph);  // no area, or a corner twice
// The same corners in the same order as an earlier one. Of a triangle and its other side both stay.
void drop_duplicates(SurfaceGraph& graph);

}  // namespace handhold

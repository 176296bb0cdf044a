#pragma once

#include "engine/geometry/surface_graph.hpp"

// Drops invalid and duplicate triangles and counts them in the report. Changes only triangles and
// source_triangle: the caller has to link the graph again.
namespace handhold {

void drop_not_finite(SurfaceGraph& graph);  // a corner is NaN or infinite
void drop_degenerate(SurfaceGraph& graph);  // zero area, or two equal corners
// Same corners in the same order as an earlier triangle. The reverse side of a triangle is kept.
void drop_duplicates(SurfaceGraph& graph);

}  // namespace handhold

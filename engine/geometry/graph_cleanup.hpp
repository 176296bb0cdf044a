#pragma once

#include "engine/geometry/surface_graph.hpp"

// Drops invalid and duplicate triangles and counts them in the report. Changes only triangles and
// source_triangle: the caller must call link_graph afterwards.
namespace handhold {

void drop_not_finite(SurfaceGraph& graph);  // triangles with a corner that is NaN or infinite
void drop_degenerate(SurfaceGraph& graph);  // triangles with zero area or two equal corners
// Drops triangles with the same corners in the same cyclic order as an earlier triangle. A triangle
// with the reverse order is kept.
void drop_duplicates(SurfaceGraph& graph);

}  // namespace handhold

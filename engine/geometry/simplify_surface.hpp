#pragma once

#include "engine/geometry/surface_graph.hpp"
#include "engine/geometry/triangle_bvh.hpp"

namespace handhold {

struct DetailLimits {
    double deviation_m = 2e-3;  // guaranteed limit of the two-sided Hausdorff distance; > 0
    // Target size: triangles are merged up to the area of an equilateral triangle with this edge.
    // 0: as few triangles as the deviation allows.
    double edge_m = 0.02;
};

// Simplifies each connected component. A component that cannot be simplified within the limits is
// kept. All vertices are vertices of `graph`. source_triangle is the source triangle nearest to the
// new triangle's centroid. `graph_bvh` holds the graph's triangles; null: it is built. Components
// of more than 100,000 triangles are divided into tiles whose borders are kept. Components and
// tiles are distributed over the threads of parallel_for, which does not affect the result.
SurfaceGraph simplify_surface(const SurfaceGraph& graph, const DetailLimits& limits,
                              const TriangleBvh* graph_bvh = nullptr);

}  // namespace handhold

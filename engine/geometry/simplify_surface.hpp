#pragma once

#include "engine/geometry/surface_graph.hpp"
#include "engine/geometry/triangle_bvh.hpp"

namespace handhold {

struct DetailLimits {
    double deviation_m = 2e-3;  // between the two surfaces, both ways, proven; > 0
    // Triangles are joined until they are about as large as equilateral ones with this edge; larger
    // ones stay as they are. 0: as few as the deviation lets be.
    double edge_m = 0.02;
};

// A coarser surface, part by part: a part that cannot be made coarser within the limits stays as it
// is. Corners are corners of `graph`; source_triangle names the triangle of graph's source
// nearest to the middle of each. `graph_bvh` is of the graph's triangles, or null: then it is
// built. Parts of more than 100,000 triangles are divided into tiles whose borders stay as they
// are; tiles and parts are shared out over the threads of parallel_for, which never shows in the
// result.
SurfaceGraph simplify_surface(const SurfaceGraph& graph, const DetailLimits& limits,
                              const TriangleBvh* graph_bvh = nullptr);

}  // namespace handhold

#pragma once

#include "engine/geometry/surface_graph.hpp"

namespace handhold {

struct DetailLimits {
    double deviation_m = 2e-3;  // between the two surfaces, both ways, proven; > 0
    // Triangles are joined until they are about as large as equilateral ones with this edge; larger
    // ones stay as they are. 0: as few as the deviation lets be.
    double edge_m = 0.02;
};

// A coarser surface, part by part: a part that cannot be made coarser within the limits stays as it
// is. Corners are corners of `graph`; source_triangle names the triangle of graph's source
// nearest to the middle of each.
SurfaceGraph simplify_surface(const SurfaceGraph& graph, const DetailLimits& limits);

}  // namespace handhold

#pragma once

#include "engine/collision/shape_library.hpp"
#include "engine/geometry/surface_graph.hpp"
#include "engine/geometry/triangle_bvh.hpp"

namespace handhold {

struct GripMeshSettings {
    WeldLimits weld;
    double shape_tolerance_m = 1e-4;  // of round shapes' triangles from the true surface, > 0
};

// What one shape gives to hands, in the shape's frame: a coarse surface to search on and a fine one
// to touch. A cache, never state. Read only once built: any number of threads may query it.
struct GripMesh {
    SurfaceGraph contact;
    TriangleBvh contact_bvh;  // of contact's triangles
    SurfaceGraph search;
    TriangleBvh search_bvh;  // of search's triangles
};

GripMesh build_grip_mesh(const Mesh& mesh, const GripMeshSettings& settings = {});
GripMesh build_grip_mesh(const Shape& shape, const GripMeshSettings& settings = {});

}  // namespace handhold

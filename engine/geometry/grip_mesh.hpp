#pragma once

#include <cstdint>
#include <filesystem>

#include "engine/collision/shape_library.hpp"
#include "engine/geometry/simplify_surface.hpp"
#include "engine/geometry/surface_graph.hpp"
#include "engine/geometry/triangle_bvh.hpp"

namespace handhold {

struct GripMeshSettings {
    WeldLimits weld;
    double shape_tolerance_m = 1e-4;  // of round shapes' triangles from the true surface, > 0
    // What hands search on.
    DetailLimits search = {.deviation_m = 2.5e-3, .edge_m = 0.02};
    // What hands touch: a deviation of 0 takes the mesh as it is; so does a mesh that would keep
    // more than contact_share of its triangles.
    DetailLimits contact = {.deviation_m = 5e-4, .edge_m = 0.0};
    double contact_share = 0.7;
    // Meshes smaller than this whose closed parts are inside out are turned. Larger ones may be
    // rooms, seen from inside. 0: none.
    double flip_below_m = 1.0;
};

// What one shape gives to hands, in the shape's frame: a coarse surface to search on and a fine one
// to touch. Triangles of a sheet are wound alike, so that neighbours' normals agree; on a sheet
// that is open, or of a room, either side may be the outer. A cache, never state. Read only once
// built: any number of threads may query it.
struct GripMesh {
    SurfaceGraph contact;
    TriangleBvh contact_bvh;  // of contact's triangles
    SurfaceGraph search;
    TriangleBvh search_bvh;    // of search's triangles
    std::uint32_t turned = 0;  // triangles that were wound against their sheet or inside out
    std::uint32_t full_triangles = 0;  // of the graph at full detail
};

GripMesh build_grip_mesh(const Mesh& mesh, const GripMeshSettings& settings = {});
// Round shapes are tessellated; contact is then not made coarser: its tolerance is set already.
GripMesh build_grip_mesh(const Shape& shape, const GripMeshSettings& settings = {});

std::size_t memory_bytes(const GripMesh& grip);

}  // namespace handhold

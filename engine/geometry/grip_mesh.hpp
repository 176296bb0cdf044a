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
    // Deviation of round shapes' triangles from the true surface, > 0.
    double shape_tolerance_m = 1e-4;
    // Detail for graph searches.
    DetailLimits search = {.deviation_m = 2.5e-3, .edge_m = 0.02};
    // Detail for contact. Keeps the full mesh if the deviation is 0 or if more than contact_share
    // of its triangles would remain.
    DetailLimits contact = {.deviation_m = 5e-4, .edge_m = 0.0};
    double contact_share = 0.7;
    // Closed components of a smaller mesh are flipped if they are inside out. Larger meshes may be
    // rooms seen from inside. 0: never.
    double flip_below_m = 1.0;
};

// Grip surface of one shape in the shape's frame: a coarse detail to search on and a fine one to
// touch. Triangles of a sheet are wound alike, so neighbours' normals agree. On open sheets and
// rooms either side may be the outer one. Derived data, never state. Immutable once built: any
// number of threads may query it.
struct GripMesh {
    SurfaceGraph contact;
    TriangleBvh contact_bvh;  // over contact's triangles
    SurfaceGraph search;
    TriangleBvh search_bvh;            // over search's triangles
    std::uint32_t turned = 0;          // triangles flipped to match their sheet or to face out
    std::uint32_t full_triangles = 0;  // triangles at full detail
};

GripMesh build_grip_mesh(const Mesh& mesh, const GripMeshSettings& settings = {});
// Round shapes are tessellated within shape_tolerance_m; their contact detail is not simplified.
GripMesh build_grip_mesh(const Shape& shape, const GripMeshSettings& settings = {});

std::size_t memory_bytes(const GripMesh& grip);

}  // namespace handhold

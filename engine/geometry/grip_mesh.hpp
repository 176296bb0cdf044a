#pragma once

#include <cstdint>
#include <filesystem>

#include "engine/geometry/shape_library.hpp"
#include "engine/geometry/simplify_surface.hpp"
#include "engine/geometry/surface_graph.hpp"
#include "engine/geometry/triangle_bvh.hpp"

namespace handhold {

struct GripMeshSettings {
    WeldLimits weld;
    // Largest distance of a round shape's triangles from its true surface, > 0.
    double shape_tolerance_m = 3e-4;
    // Detail for graph searches.
    DetailLimits search = {.deviation_m = 2.5e-3, .edge_m = 0.02};
    // Detail for contact. If the deviation is 0, or if more than contact_share of the full mesh's
    // triangles would remain, the full mesh is used.
    DetailLimits contact = {.deviation_m = 5e-4, .edge_m = 0.0};
    double contact_share = 0.7;
    // If a mesh is smaller than this, its closed components are flipped if they are inside out. A
    // larger mesh may be a room seen from inside. 0: never flips.
    double flip_below_m = 1.0;
};

// Grip surface of one shape in the shape's frame: a coarse detail for searches and a fine one for
// contact. All triangles of a sheet have the same winding, so neighbours' normals agree. On open
// sheets and in rooms either side may be the outer one. Derived data, never state. Immutable once
// built, so any number of threads may query it.
struct GripMesh {
    SurfaceGraph contact;
    TriangleBvh contact_bvh;  // tree of contact's triangles
    SurfaceGraph search;
    TriangleBvh search_bvh;            // tree of search's triangles
    std::uint32_t turned = 0;          // triangles flipped to match their sheet or to face outwards
    std::uint32_t full_triangles = 0;  // number of triangles at full detail
    // Hash of the contact detail, equal on every machine. Two meshes that were built with the same
    // settings and have the same digest are taken for equal.
    std::uint64_t digest = 0;
};

// Hash of positions and triangles, for GripMesh::digest.
std::uint64_t digest_of(const SurfaceGraph& contact);

GripMesh build_grip_mesh(const Mesh& mesh, const GripMeshSettings& settings = {});
// Round shapes are tessellated within shape_tolerance_m; their contact detail is not simplified.
// Spheres and capsules are built directly: round_grip_mesh.hpp.
GripMesh build_grip_mesh(const Shape& shape, const GripMeshSettings& settings = {});

// The mesh with all lengths times `factor`, > 0. Not what build_grip_mesh makes of the resized
// source: detail and welds stay those of the original.
GripMesh resized(const GripMesh& grip, double factor);

std::size_t memory_bytes(const GripMesh& grip);

}  // namespace handhold

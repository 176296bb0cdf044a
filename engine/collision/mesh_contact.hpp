#pragma once

#include <vector>

#include "engine/collision/bullet_manifold.hpp"
#include "engine/collision/near_triangles.hpp"

// What a triangle mesh needs beyond convex shapes: which side is outside, and which normals its
// surface really has.
namespace handhold {

// True where the triangles' surface nowhere rises above the plane through `point` (on the surface)
// across `normal`: only then can something touch it there along that normal. False marks an
// internal edge's bent normal.
bool in_normal_cone(const NearTriangles& triangles, const Vec3& point, const Vec3& normal);

struct MeshContactIo {
    const Convex& a;
    double core_reach_m = 0.0;  // from a's centre to its core's corners
    Vec3 centre_from_ns;  // a's centre at its last valid pose, relative to the mesh: marks the
                          // outside
    const NearTriangles&
        triangles;  // all within margin_m of a, and of the way from centre_from_ns to a's centre
    double margin_m = 0.0;
    TriangleShape& triangle;             // memory
    ClipScratch& scratch;                // memory
    std::vector<NearContact>& contacts;  // appended
};
// Contacts of a convex core with the triangles of one mesh. Walls have no inside: where the way of
// a's centre went through a triangle, the sides that it left behind push back, as deep as a has
// passed them.
void add_mesh_contacts(const MeshContactIo& io);

}  // namespace handhold

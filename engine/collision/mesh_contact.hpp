#pragma once

#include <vector>

#include "engine/collision/bullet_manifold.hpp"
#include "engine/collision/near_triangles.hpp"

// Contacts with triangle meshes: which side is outside, and which contact normals are artefacts of
// internal edges.
namespace handhold {

// True if the surface around `point` (on the surface) nowhere rises above the plane through it with
// normal `normal`: only then can a body touch there along that normal. False marks the tilted
// normal of an internal edge.
bool in_normal_cone(const NearTriangles& triangles, const Vec3& point, const Vec3& normal);

struct MeshContactIo {
    const Convex& a;
    double core_reach_m = 0.0;  // from a's centre to its core's farthest point
    // a's centre at its last valid pose, relative to the mesh: marks the outside.
    Vec3 centre_from_ns;
    // All triangles within margin_m of a and of the segment from centre_from_ns to a's centre.
    const NearTriangles& triangles;
    double margin_m = 0.0;
    TriangleShape& triangle;             // scratch
    ClipScratch& scratch;                // scratch
    std::vector<NearContact>& contacts;  // appended to
};
// Contacts of a convex core with the triangles of one mesh. If a's centre crossed a triangle on its
// motion, contact normals face the side it came from, with the full depth by which a has passed.
void add_mesh_contacts(const MeshContactIo& io);

}  // namespace handhold

#pragma once

#include <vector>

#include "engine/collision/bullet_manifold.hpp"
#include "engine/collision/near_triangles.hpp"

// Contacts with triangle meshes. Decides which side of the surface is outside, and which contact
// normals are artefacts of internal edges.
namespace handhold {

// True if a body can touch the surface at `point` along `normal`: nowhere around `point` does the
// surface rise above the plane through `point` with this normal. False marks the tilted normal of
// an internal edge. `point` is on the surface.
bool in_normal_cone(const NearTriangles& triangles, const Vec3& point, const Vec3& normal);

struct MeshContactIo {
    const Convex& a;
    double core_reach_m = 0.0;  // distance from a's centre to its core's farthest point
    // a's centre at its last valid pose, relative to the mesh. Its side of the surface is outside.
    Vec3 centre_from_ns;
    // All triangles within margin_m of a and of the segment from centre_from_ns to a's centre.
    const NearTriangles& triangles;
    double margin_m = 0.0;
    TriangleShape& triangle;             // scratch
    ClipScratch& scratch;                // scratch
    std::vector<NearContact>& contacts;  // appended to
};
// Adds the contacts of a convex shape with the triangles of one mesh. If a's centre crossed a
// triangle on its motion, contact normals face the side that the centre came from, and depths are
// measured to that side.
void add_mesh_contacts(const MeshContactIo& io);

}  // namespace handhold

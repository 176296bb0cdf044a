#pragma once

#include "engine/collision/bullet_separation.hpp"
#include "engine/collision/contact_outline.hpp"

// Contact manifolds of convex shapes, by face clipping.
namespace handhold {

// Scratch memory. Its content is not used between calls.
struct ClipScratch {
    btAlignedObjectArray<btVector3> polygon;
    btAlignedObjectArray<btVector3> clipped;
};

// Appends contacts along the separation's normal, with separations below `margin_m`. The closest
// pair of points is always among them if its separation is below `margin_m`.
void add_manifold(const Convex& a, const Convex& b, const CoreSeparation& separation,
                  double margin_m, ClipScratch& scratch, std::vector<NearContact>& contacts);

// Appends contacts between a and the plane of triangle b, at points of a that project onto the
// triangle. `normal` is the triangle's normal on its outer side. Depths are measured to the plane,
// even if a is far behind it.
void add_face_manifold(const Convex& a, const Convex& b, const Vec3& normal, double margin_m,
                       ClipScratch& scratch, std::vector<NearContact>& contacts);

}  // namespace handhold

#pragma once

#include "engine/collision/bullet_separation.hpp"
#include "engine/collision/contact_outline.hpp"

// Contact manifolds of convex shapes, by face clipping.
namespace handhold {

// Scratch. The content means nothing between calls.
struct ClipScratch {
    btAlignedObjectArray<btVector3> polygon;
    btAlignedObjectArray<btVector3> clipped;
};

// Appends the contacts of a pair along the separation's normal with separation below `margin_m`: at
// least the closest pair of points, if it is that near.
void add_manifold(const Convex& a, const Convex& b, const CoreSeparation& separation,
                  double margin_m, ClipScratch& scratch, std::vector<NearContact>& contacts);

// Appends the contacts of a with the plane of triangle b, for points of a that project onto the
// triangle. `normal` is the triangle's normal on its outer side. The depth is measured to the
// plane, however far a is past it.
void add_face_manifold(const Convex& a, const Convex& b, const Vec3& normal, double margin_m,
                       ClipScratch& scratch, std::vector<NearContact>& contacts);

}  // namespace handhold

#pragma once

#include "engine/collision/bullet_separation.hpp"
#include "engine/collision/contact_outline.hpp"

// The points where convex shapes hold each other (face clipping).
namespace handhold {

// Memory that is reused; its content means nothing between calls.
struct ClipScratch {
    btAlignedObjectArray<btVector3> polygon;
    btAlignedObjectArray<btVector3> clipped;
};

// Appends the contacts of a pair along its separation's normal that are nearer than `margin_m`. At
// least the nearest point, if that is near enough.
void add_manifold(const Convex& a, const Convex& b, const CoreSeparation& separation,
                  double margin_m, ClipScratch& scratch, std::vector<NearContact>& contacts);

// Appends the contacts of a with the plane of triangle b, where a's points lie over (or, sunk,
// under) the triangle. The normal is given: the triangle's own on the side that counts as outside.
// Depth is measured to that side, however deep a is sunk.
void add_face_manifold(const Convex& a, const Convex& b, const Vec3& normal, double margin_m,
                       ClipScratch& scratch, std::vector<NearContact>& contacts);

}  // namespace handhold

#pragma once

#include <vector>

#include "engine/collision/convex_core.hpp"

// From the normal of a pair to the points that hold it: the clipped common part of two faces, of a
// face and an edge, or of two edges.
namespace handhold {

// A contact point of one pair in near space: b's axes about a's place.
struct NearContact {
    Vec3 point_a_ns = Vec3::Zero();  // on a's surface
    Vec3 point_b_ns = Vec3::Zero();  // on b's surface
    Vec3 normal_ns = Vec3::UnitY();  // unit, from b towards a
    double separation_m = 0.0;       // normal . (point_a - point_b)
};

// Appends the contacts of a pair along its separation's normal that are nearer than `margin_m`. At
// least the nearest point, if that is near enough.
void add_manifold(const ConvexCore& a, const ConvexCore& b, const CoreSeparation& separation,
                  double margin_m, std::vector<NearContact>& contacts);

// Appends the contacts of a with the plane of triangle b, where a's points lie over (or, sunk,
// under) the triangle. The normal is given: the triangle's own on the side that counts as outside.
// Depth is measured to that side, however deep a is sunk.
void add_face_manifold(const ConvexCore& a, const ConvexCore& b, const Vec3& normal,
                       double margin_m, std::vector<NearContact>& contacts);

// Sorts contacts by place, merges equal ones, and leaves of each group of (nearly) equal normal
// only what bounds the rest: the corners of its outline, at most 8, and the deepest. The others
// would be redundant rows: a rigid body that meets the corners meets them. `scratch` is any vector:
// its content is lost, its memory is reused.
void reduce_contacts(std::vector<NearContact>& contacts, std::vector<NearContact>& scratch);

}  // namespace handhold

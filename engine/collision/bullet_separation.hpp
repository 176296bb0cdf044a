#pragma once

#include <optional>

#include "engine/collision/bullet_convex.hpp"

// Signed distance of two convex cores (shapes without their radii): of boxes
// (bullet_box_separation.hpp), and of a sphere from a triangle, in closed form; of all others by
// Bullet's GJK and EPA. All values are in near space (suffix _ns): b's axes with the origin at a's
// position.
namespace handhold {

struct CoreSeparation {
    // Unit vector from b towards a, along the shortest connection. If the cores overlap: the
    // direction of the shortest translation of a that separates them.
    Vec3 normal = Vec3::UnitY();
    // Negative: penetration depth, the length of the shortest translation that separates the cores.
    double separation_m = 0.0;
    Vec3 point_a_ns = Vec3::Zero();  // closest pair of points; deepest if the cores overlap
    Vec3 point_b_ns = Vec3::Zero();
    bool overlap = false;
};
CoreSeparation separate(const Convex& a, const Convex& b);
// nullopt only if the distance of the cores exceeds `limit_m`.
std::optional<CoreSeparation> separate_within(const Convex& a, const Convex& b, double limit_m);
// Separation of a and b along the line of their centres, in metres, radii included: never more than
// their distance, and negative if that line does not separate them.
double gap_along_centres(const Convex& a, const Convex& b);

}  // namespace handhold

#pragma once

#include "engine/collision/bullet_convex.hpp"

// Signed distance of two convex cores, by Bullet's GJK and EPA.
namespace handhold {

// Signed distance of two cores; radii are not included.
struct CoreSeparation {
    // Unit, from b towards a: along the shortest connection, or along the shortest exit from b if
    // the cores overlap.
    Vec3 normal = Vec3::UnitY();
    // Negative: penetration depth, the shortest translation that separates the cores.
    double separation_m = 0.0;
    Vec3 point_a_ns = Vec3::Zero();  // closest (or deepest) pair of points
    Vec3 point_b_ns = Vec3::Zero();
    bool overlap = false;
};
CoreSeparation separate(const Convex& a, const Convex& b);

}  // namespace handhold

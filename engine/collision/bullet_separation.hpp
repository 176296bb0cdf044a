#pragma once

#include "engine/collision/bullet_convex.hpp"

// The distance of convex cores by Bullet's GJK and EPA.
namespace handhold {

// How far two cores are apart, radii left out.
struct CoreSeparation {
    Vec3 normal = Vec3::UnitY();  // unit, from b towards a: along the shortest way between the
                                  // cores, or out of b where they overlap
    double separation_m =
        0.0;  // negative: the least way along which a core must move to be free of the other
    Vec3 point_a_ns = Vec3::Zero();  // a pair of points of the cores that are this far apart
    Vec3 point_b_ns = Vec3::Zero();
    bool overlap = false;
};
CoreSeparation separate(const Convex& a, const Convex& b);

}  // namespace handhold

#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/geometry/triangle_bvh.hpp"

namespace handhold {

// A surface as far as distances to it go. Refers to what it is made of.
struct TriangleSurface {
    std::span<const Vec3> positions;
    std::span<const std::array<std::uint32_t, 3>> triangles;
    const TriangleBvh& bvh;  // of these
};

// A triangle with a point that is not proven to be near.
struct Uncovered {
    std::uint32_t triangle = 0;
    Vec3 point = Vec3::Zero();  // farther off than the limit, or within a fiftieth of it
};

// The triangles of `a` of which not every point is proven to be as near as limit_m to `b`; none
// where a's one-sided Hausdorff distance to b is below. By cutting triangles until each piece has
// its corners near to one triangle of b: the distance to a convex set is convex, so what is between
// them is near as well. Takes long where the limit is far below the triangles' size and they do not
// lie on each other.
std::vector<Uncovered> find_uncovered(const TriangleSurface& a, const TriangleSurface& b,
                                      double limit_m);

}  // namespace handhold

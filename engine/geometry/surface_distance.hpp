#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "engine/geometry/triangle_bvh.hpp"

namespace handhold {

// A surface as far as distances to it go. Refers to what it is made of.
struct TriangleSet {
    std::span<const Vec3> positions;
    std::span<const std::array<std::uint32_t, 3>> triangles;
    const TriangleBvh& bvh;  // of these
};

// True where every point of every triangle of `a` is proven to be as near as limit_m to `b`: the
// one-sided Hausdorff distance. By cutting triangles until each piece has its corners near to one
// triangle of b: the distance to a convex set is convex, so what is between them is near as well.
// False where some point is farther, or within about a thousandth of the limit.
bool is_covered(const TriangleSet& a, const TriangleSet& b, double limit_m);

}  // namespace handhold

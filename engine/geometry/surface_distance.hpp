#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/geometry/triangle_bvh.hpp"

namespace handhold {

// A surface for distance queries. Refers to its data, which must outlive it.
struct TriangleSurface {
    std::span<const Vec3> positions;
    std::span<const std::array<std::uint32_t, 3>> triangles;
    const TriangleBvh& bvh;  // built from `positions` and `triangles`
};

// Size of the smallest piece, as a fraction of the limit. Distances within this fraction of the
// limit count as beyond the limit.
inline constexpr double k_min_piece_share = 0.02;

// A triangle with a point that is not proven to be within the limit of the other surface.
struct Uncovered {
    std::uint32_t triangle = 0;
    Vec3 point = Vec3::Zero();  // farther than the limit, or within k_min_piece_share of it
};

// The triangles of `a` that are not proven to lie entirely within limit_m of `b`. Empty if the
// one-sided Hausdorff distance from a to b is clearly below the limit. Subdivides each triangle
// until all corners of a piece are near one triangle of b; the whole piece is then near, because
// the distance to a convex set is convex. Slow if the limit is far below the triangles' size and
// the surfaces do not coincide.
std::vector<Uncovered> find_uncovered(const TriangleSurface& a, const TriangleSurface& b,
                                      double limit_m);

}  // namespace handhold

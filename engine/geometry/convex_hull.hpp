#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/math/math.hpp"

// Convex hull of points as a polyhedron. Source: Barber, Dobkin, Huhdanpaa, The Quickhull Algorithm
// for Convex Hulls, 1996 (farthest point first, with lists of outside points per face). The corner
// limit and the face merging are our own.
namespace handhold {

struct HullFace {
    std::vector<std::uint32_t> loop;  // corner indices, counter-clockwise from outside
    Vec3 normal = Vec3::UnitY();      // unit, outward
    double offset_m = 0.0;            // no corner satisfies normal . x > offset_m
};

// A closed polyhedron: each edge occurs once in each direction.
struct ConvexHull {
    std::vector<Vec3> corners;  // sorted by x, y, z
    std::vector<HullFace> faces;
    double width_m = 0.0;    // smallest extent in any direction
    double omitted_m = 0.0;  // largest distance of an input point outside the hull
};

constexpr std::size_t k_max_hull_corners = 64;  // so at most 124 faces

// The result does not depend on the order of the points. The tolerance is 1e-6 of the diagonal of
// the points' bounding box. A point that lies outside the hull by less than the tolerance adds no
// corner. Neighbouring triangles become one face if their corners lie in one plane within twice the
// tolerance. At most k_max_hull_corners points become corners, farthest first; omitted_m is how
// much is cut off. Returns nullopt if all points lie in one plane within the tolerance, or if one
// is not finite.
std::optional<ConvexHull> make_convex_hull(std::span<const Vec3> points);

// The polyhedron transformed by `pose`.
ConvexHull moved_hull(const ConvexHull& hull, const Pose& pose);

}  // namespace handhold

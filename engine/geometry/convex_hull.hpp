#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/math/math.hpp"

// The convex hull of points as a polyhedron.
// Sources: Barber, Dobkin, Huhdanpaa, The Quickhull Algorithm for Convex Hulls, 1996 (the farthest
// point first, over lists of the points outside of each face); the limit and the merging are ours.
namespace handhold {

struct HullFace {
    std::vector<std::uint32_t> loop;  // of corners, counter-clockwise seen from outside
    Vec3 normal = Vec3::UnitY();      // unit, outward
    double offset_m = 0.0;            // the plane normal . x == offset_m has no corner outside
};

// Watertight: each edge is run through once in each direction.
struct ConvexHull {
    std::vector<Vec3> corners;  // sorted by place
    std::vector<HullFace> faces;
    double width_m = 0.0;    // its thinnest extent, in whatever direction
    double omitted_m = 0.0;  // no given point is farther outside than this
};

constexpr std::size_t k_max_hull_corners = 64;  // and so at most 124 faces

// The hull of the points, whatever their order. Points nearer to it than a millionth of its size
// add no corner, and corners that lie so near to one plane bound one face. Of more corners than
// k_max_hull_corners those are taken that stand out most, one after another: omitted_m says what
// that cut off. nullopt where the points lie in a plane to a millionth of their size, or one is not
// finite.
std::optional<ConvexHull> make_convex_hull(std::span<const Vec3> points);

// The same polyhedron in another frame: its points p become transform_point(pose, p).
ConvexHull moved_hull(const ConvexHull& hull, const Pose& pose);

}  // namespace handhold

#pragma once

#include "engine/geometry/shape_library.hpp"

// Axis-aligned bounding boxes, and swept bounds: boxes around everything that a shape passes
// through in one frame.
namespace handhold {

// Margin added to swept bounds so that rounding errors never hide a contact. Rounding errors of
// doubles are much smaller, for instance even 100 km from the origin.
constexpr double k_rounding_m = 1e-6;

struct Bounds {
    Vec3 low = Vec3::Zero();
    Vec3 high = Vec3::Zero();

    Bounds grown(double margin_m) const {
        return {low - Vec3::Constant(margin_m), high + Vec3::Constant(margin_m)};
    }
    Bounds joined(const Bounds& other) const {
        return {low.cwiseMin(other.low), high.cwiseMax(other.high)};
    }
};

inline Bounds bounds_of(const Vec3& from, const Vec3& to) {
    return {from.cwiseMin(to), from.cwiseMax(to)};
}

// True if the boxes share a point; touching counts.
inline bool overlaps(const Bounds& a, const Bounds& b) {
    return (a.low.array() <= b.high.array()).all() && (b.low.array() <= a.high.array()).all();
}

// True if `inner` lies within `outer`; equal faces count.
inline bool contains(const Bounds& outer, const Bounds& inner) {
    return (outer.low.array() <= inner.low.array()).all() &&
           (inner.high.array() <= outer.high.array()).all();
}

inline Bounds intersection(const Bounds& a, const Bounds& b) {
    return {a.low.cwiseMax(b.low), a.high.cwiseMin(b.high)};
}

// Bounds, in the parent frame of `pose`, of a box that is given in the frame of `pose`.
Bounds transformed(const Bounds& bounds, const Pose& pose);

// Size of a shape, as needed to compute bounds. Stored per shape, because computing it for a mesh
// visits every vertex.
struct ShapeExtent {
    Bounds box;             // box in the shape's frame
    double radius_m = 0.0;  // bounding sphere about the shape's origin
};
ShapeExtent shape_extent(const Shape& shape);
// Extent of a part of a compound: `box` is in the compound's frame, `radius_m` about its origin.
ShapeExtent part_extent(const PlacedShape& part);

// Box that contains every point of the shape on its motion from one pose to the other. The position
// moves linearly, the rotation along the shorter arc.
Bounds swept_bounds(const ShapeExtent& extent, const Pose& from, const Pose& to);

}  // namespace handhold

#pragma once

#include "engine/collision/shape_library.hpp"

// Axis-aligned bounding boxes, and swept bounds: a box around a shape over its whole motion of a
// frame.
namespace handhold {

// Added to swept bounds so that rounding never hides a contact. Far above double rounding at 100
// km.
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

// The part of a shape that bounds need. Computed once per shape, because a mesh's takes a pass over
// its vertices.
struct ShapeExtent {
    Bounds box;             // in the shape's frame
    double radius_m = 0.0;  // bounding sphere about the shape's origin
};
ShapeExtent shape_extent(const Shape& shape);
// The same for a part of a compound: in the compound's frame, about the compound's origin.
ShapeExtent part_extent(const PlacedShape& part);

// Contains every point of the shape on its motion from one pose to the other (position linear,
// rotation along the shorter arc).
Bounds swept_bounds(const ShapeExtent& extent, const Pose& from, const Pose& to);

}  // namespace handhold

#pragma once

#include "engine/collision/shape_library.hpp"

// Axis-aligned boxes that hold a shape on its whole way through a frame.
namespace handhold {

constexpr double k_rounding_m =
    1e-6;  // added to bounds, so that rounding never hides a touch; far above that of 100 km

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

// True where two boxes have a point in common.
inline bool meet(const Bounds& a, const Bounds& b) {
    return (a.low.array() <= b.high.array()).all() && (b.low.array() <= a.high.array()).all();
}

// True where the second lies in the first.
inline bool holds(const Bounds& outer, const Bounds& inner) {
    return (outer.low.array() <= inner.low.array()).all() &&
           (inner.high.array() <= outer.high.array()).all();
}

inline Bounds common(const Bounds& a, const Bounds& b) {
    return {a.low.cwiseMax(b.low), a.high.cwiseMin(b.high)};
}

// The box about a box in another frame; `pose`: of its own.
Bounds transformed(const Bounds& bounds, const Pose& pose);

// What bounds need of a shape, found once: a mesh's takes a walk over its vertices.
struct ShapeExtent {
    Bounds box;             // in the shape's frame
    double radius_m = 0.0;  // about its origin
};
ShapeExtent shape_extent(const Shape& shape);
// In the frame, and about the origin, of what it is a part of.
ShapeExtent part_extent(const PlacedShape& part);

// Covers every point of the shape on the way from one pose to another.
Bounds swept_bounds(const ShapeExtent& extent, const Pose& from, const Pose& to);

}  // namespace handhold

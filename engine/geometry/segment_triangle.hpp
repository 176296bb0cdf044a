#pragma once

#include <array>

#include "engine/collision/closest_point.hpp"
#include "engine/math/math.hpp"

namespace handhold {

// The nearest pair of points of a segment and a triangle, and their distance: 0 where the segment
// passes through.
struct SegmentTriangle {
    Vec3 on_segment = Vec3::Zero();
    Vec3 on_triangle = Vec3::Zero();
    double distance_m = 0.0;
};
SegmentTriangle nearest_between(const std::array<Vec3, 2>& segment, const Corners& triangle);
// The same where a normal is known: of any length, zero for a triangle without area.
SegmentTriangle nearest_between(const std::array<Vec3, 2>& segment, const Corners& triangle,
                                const Vec3& normal);

}  // namespace handhold

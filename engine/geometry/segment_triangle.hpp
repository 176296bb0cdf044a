#pragma once

#include <array>

#include "engine/geometry/closest_point.hpp"
#include "engine/math/math.hpp"

namespace handhold {

// Nearest points of a segment and a triangle; distance 0 if the segment crosses the triangle.
struct SegmentTriangle {
    Vec3 on_segment = Vec3::Zero();
    Vec3 on_triangle = Vec3::Zero();
    double distance_m = 0.0;
};
SegmentTriangle nearest_between(const std::array<Vec3, 2>& segment, const Corners& triangle);
// `normal` is the triangle's, of any length; zero for a degenerate triangle.
SegmentTriangle nearest_between(const std::array<Vec3, 2>& segment, const Corners& triangle,
                                const Vec3& normal);

}  // namespace handhold

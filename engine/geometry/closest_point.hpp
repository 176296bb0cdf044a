#pragma once

#include <array>
#include <utility>

#include "engine/math/math.hpp"

// Closest points on segments and triangles, in closed form. All arguments of one call share one
// space. Source: Ericson, Real-Time Collision Detection, 2005, chapter 5; degenerate triangles are
// handled differently, as noted in the implementation.
namespace handhold {

using Corners = std::array<Vec3, 3>;  // corners of a triangle

// Twice the area times the unit normal. Zero if the area is within rounding of zero (degenerate
// triangle).
Vec3 area_vector(const Corners& corners);

Vec3 closest_on_segment(const Vec3& point, const Vec3& from, const Vec3& to);
// Valid for any triangle, including degenerate ones.
Vec3 closest_on_triangle(const Vec3& point, const Corners& corners);
// The closest points, one on each segment. Parallel segments: one of the equally near pairs.
std::pair<Vec3, Vec3> closest_between_segments(const std::array<Vec3, 2>& a,
                                               const std::array<Vec3, 2>& b);

}  // namespace handhold

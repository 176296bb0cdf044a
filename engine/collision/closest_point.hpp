#pragma once

#include <array>
#include <utility>

#include "engine/math/math.hpp"

// Closest points in closed form. All arguments of one call share one space.
// Sources: Ericson, Real-Time Collision Detection, 2005, chapter 5 (the queries); slivers are
// handled otherwise, see the bodies.
namespace handhold {

using Corners = std::array<Vec3, 3>;  // of a triangle

// Twice the area times the unit normal; zero where the triangle has no area that double precision
// can tell from none.
Vec3 area_vector(const Corners& corners);

Vec3 closest_on_segment(const Vec3& point, const Vec3& from, const Vec3& to);
// Any triangle, slivers and those without area included.
Vec3 closest_on_triangle(const Vec3& point, const Corners& corners);
// One point on each segment. Where many pairs are equally near (parallel segments), one of them.
std::pair<Vec3, Vec3> closest_between_segments(const std::array<Vec3, 2>& a,
                                               const std::array<Vec3, 2>& b);

}  // namespace handhold

#pragma once

#include <span>
#include <vector>

#include "engine/geometry/mesh.hpp"

// Closed surfaces lofted over rings of points. Lengths in metres; triangles are counter-clockwise
// seen from outside.
namespace handhold {

// Points around +Z, counter-clockwise seen from +Z.
using Ring = std::vector<Vec3>;

// Lofts a surface over rings with equal numbers of points, in order along +Z. The rings are
// counter-clockwise seen from the last ring. The first and the last ring may be a single point,
// where the surface closes. `capped` closes open ends with a fan around their mean point. `looped`
// joins the last ring to the first, which gives a solid with a hole.
enum class LoftEnds { capped, looped };
Mesh make_loft(std::span<const Ring> rings, LoftEnds ends);

// Outline of a rectangle whose corners are rounded by `corner_steps` chords (1: chamfered). Each
// straight side has `side_steps` pieces, so that outlines of different shape can be lofted.
// Precondition: corner_m is below both half sizes.
struct RoundedRect {
    double half_x_m = 1.0;
    double half_y_m = 1.0;
    double corner_m = 0.1;
    int corner_steps = 4;
    int side_steps = 1;
};
Ring make_outline(const RoundedRect& rect, double z_m);
// Moves the outline's points radially onto a circle around Z.
Ring round_outline(const Ring& outline, double radius_m);
Ring at_height(Ring ring, double z_m);

// One ring of a surface of revolution around Z. Only the first and the last may have radius 0.
struct ProfilePoint {
    double radius_m = 0.0;
    double z_m = 0.0;
};
Mesh make_revolved(std::span<const ProfilePoint> profile, int segments);

}  // namespace handhold

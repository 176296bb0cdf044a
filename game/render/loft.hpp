#pragma once

#include <span>
#include <vector>

#include "engine/geometry/mesh.hpp"

// Closed surfaces skinned over rings of points; lengths in metres, counter-clockwise from outside.
namespace handhold {

// Points around +Z, counter-clockwise seen from +Z.
using Ring = std::vector<Vec3>;

// A skin over rings of equal length that follow each other towards +Z (counter-clockwise seen from
// the last one); the first and the last may be a single point, where the skin closes. `capped`
// closes open ends with a fan about their mean point; `looped` joins the last ring to the first: a
// solid with a hole.
enum class LoftEnds { capped, looped };
Mesh make_loft(std::span<const Ring> rings, LoftEnds ends);

// Outline of a rectangle with its corners rounded by `corner_steps` chords (1: chamfered). Each
// straight side is cut into `side_steps` pieces, so that outlines of different shape can be lofted.
// Precondition: corner < both halves.
struct RoundedRect {
    double half_x_m = 1.0;
    double half_y_m = 1.0;
    double corner_m = 0.1;
    int corner_steps = 4;
    int side_steps = 1;
};
Ring make_outline(const RoundedRect& rect, double z_m);
// The outline's points pushed out (or in) along their own directions onto a circle about Z.
Ring round_outline(const Ring& outline, double radius_m);
Ring at_height(Ring ring, double z_m);

// Radius (x) and height along Z (y) of each step of a shape turned about Z. Radius 0 is allowed at
// both ends.
struct ProfilePoint {
    double radius_m = 0.0;
    double z_m = 0.0;
};
Mesh make_revolved(std::span<const ProfilePoint> profile, int segments);

}  // namespace handhold

#pragma once

#include <span>
#include <vector>

#include "engine/geometry/mesh.hpp"

// Shapes that the game is built from. Every maker returns a closed, welded surface, counter-clockwise from outside;
// lengths in metres. Some of them become colliders and so reach state: no libm trigonometry in here.
namespace handhold {

// Points around +Z, counter-clockwise seen from +Z.
using Ring = std::vector<Vec3>;

// A skin over rings of equal length that follow each other towards +Z (counter-clockwise seen from the last one);
// the first and the last may be a single point, where the skin closes. `capped` closes open ends with a fan about
// their mean point; `looped` joins the last ring to the first: a solid with a hole.
enum class LoftEnds { capped, looped };
Mesh make_loft(std::span<const Ring> rings, LoftEnds ends);

// Outline of a rectangle with its corners rounded by `corner_steps` chords (1: chamfered). Each straight side is cut
// into `side_steps` pieces, so that outlines of different shape can be lofted. Precondition: corner < both halves.
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

// Radius (x) and height along Z (y) of each step of a shape turned about Z. Radius 0 is allowed at both ends.
struct ProfilePoint {
    double radius_m = 0.0;
    double z_m = 0.0;
};
Mesh make_revolved(std::span<const ProfilePoint> profile, int segments);

Mesh make_box(const Vec3& half_m);
// A box whose edges are cut at 45 degrees; 44 triangles. Precondition: bevel below every half.
Mesh make_bevelled_box(const Vec3& half_m, double bevel_m);
// A box on a wall: only the edges of its +Y face are cut; 20 triangles. Precondition: as above.
Mesh make_bevelled_slab(const Vec3& half_m, double bevel_m);
Mesh make_sphere(double radius_m, int segments = 24);
Mesh make_capsule(const Vec3& a, const Vec3& b, double radius_m, int segments = 16);
Mesh make_cylinder(const Vec3& a, const Vec3& b, double radius_m, int segments = 24);
// A round bar along a path of at least two distinct points, mitred at its bends, flat at its ends.
Mesh make_tube(std::span<const Vec3> path, double radius_m, int segments = 12);
// A ring about Z.
Mesh make_torus(double radius_m, double bar_radius_m, int segments = 32, int bar_segments = 12);
// A sphere of twenty triangles, each cut into four `levels` times.
Mesh make_icosphere(double radius_m, int levels);
// A boulder: an icosphere dented and bulged. The seed names the boulder.
Mesh make_rock(double radius_m, unsigned seed);

// Adds a copy of `part`, moved by `at`, to `into`; name and colour of `into` stay.
void append(Mesh& into, const Mesh& part, const Pose& at = {});
// Through the plane x = 0; the winding is turned so that outside stays outside.
void mirror_x(Mesh& mesh);
// Scales each axis; factors above 0.
void stretch(Mesh& mesh, const Vec3& factors);
// Makes vertices at bitwise equal positions one, in order of first use, and drops what no triangle uses.
void weld(Mesh& mesh);

// The pose whose -Z looks along `forward` and whose +Y is as near `up` as that allows. Neither zero nor parallel.
Pose look_along(const Vec3& position, const Vec3& forward, const Vec3& up);

}  // namespace handhold

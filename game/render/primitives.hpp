#pragma once

#include <span>

#include "engine/geometry/mesh.hpp"
#include "game/render/loft.hpp"
#include "game/render/mesh_edit.hpp"

// Shapes that the game is built from. Every maker returns a closed, welded surface,
// counter-clockwise from outside; lengths in metres. Some of them become colliders and so reach
// state: no libm trigonometry in here.
namespace handhold {

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

// The pose whose -Z looks along `forward` and whose +Y is as near `up` as that allows. Neither zero
// nor parallel.
Pose look_along(const Vec3& position, const Vec3& forward, const Vec3& up);

}  // namespace handhold

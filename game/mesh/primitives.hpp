#pragma once

#include <span>

#include "engine/geometry/mesh.hpp"
#include "game/mesh/loft.hpp"
#include "game/mesh/mesh_edit.hpp"

// Basic shapes of the game. Every mesh is a closed, welded surface; its triangles are
// counter-clockwise seen from outside. Lengths in metres. Some shapes become colliders and thereby
// state, so libm trigonometry is not allowed here.
namespace handhold {

Mesh make_box(const Vec3& half_m);
// A box whose edges are cut at 45 degrees; 44 triangles. Precondition: bevel below every half size.
Mesh make_bevelled_box(const Vec3& half_m, double bevel_m);
// A box on a wall: only the edges of its +Y face are bevelled; 20 triangles. Precondition: bevel
// below every half size.
Mesh make_bevelled_slab(const Vec3& half_m, double bevel_m);
Mesh make_sphere(double radius_m, int segments = 24);
Mesh make_capsule(const Vec3& a, const Vec3& b, double radius_m, int segments = 16);
Mesh make_cylinder(const Vec3& a, const Vec3& b, double radius_m, int segments = 24);
// A round bar along a path of at least two distinct points, mitred at corners, with flat ends.
Mesh make_tube(std::span<const Vec3> path, double radius_m, int segments = 12);
// A ring about Z.
Mesh make_torus(double radius_m, double bar_radius_m, int segments = 32, int bar_segments = 12);
// An icosahedron, subdivided `levels` times. Each time every triangle is split into four.
Mesh make_icosphere(double radius_m, int levels);
// A boulder: an icosphere with noise. The seed selects the shape.
Mesh make_rock(double radius_m, unsigned seed);

// The pose whose -Z is along `forward` and whose +Y is as near `up` as possible. Precondition: both
// are non-zero and not parallel.
Pose look_along(const Vec3& position, const Vec3& forward, const Vec3& up);

}  // namespace handhold

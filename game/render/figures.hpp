#pragma once

#include <vector>

#include "engine/geometry/mesh.hpp"

// The robot that the player is, and what it holds: pictures only, no colliders. A figure is a few
// meshes in one frame, each with its own colour. Its hands are in robot_hand.hpp.
namespace handhold {

// Helmet with visor. Origin between the eyes, -Z forward, +Y up.
std::vector<Mesh> make_head();
// A bar of the arm or the body: from the origin along -Z, a collar at each end.
std::vector<Mesh> make_limb(double length_m, double radius_m);
// Chest with shoulders. Origin at the base of the neck, -Z forward, +Y up.
std::vector<Mesh> make_chest();
// Controller of the wand kind. Origin in the middle of the grip, -Z where it points, +Y its pad.
std::vector<Mesh> make_controller();

}  // namespace handhold

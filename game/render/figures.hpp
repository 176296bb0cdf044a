#pragma once

#include <vector>

#include "engine/geometry/mesh.hpp"

// The robot that the player is, and what it holds: pictures only, no colliders. A figure is a few
// meshes in one frame, each with its own colour.
namespace handhold {

enum class FigureSide { left, right };
enum class HandShape { open, grip };  // relaxed; closed around a bar of 35 mm

// About 18 cm long. Origin at the wrist, -Z to the fingers, +Y the back of the hand; the palm's
// centre lies 8 cm along -Z, and the bar of HandShape::grip runs along X through (0, -0.034,
// -0.080).
std::vector<Mesh> make_hand(FigureSide side, HandShape shape);
// The hand without its fingers, for hands whose fingers are posed link by link.
std::vector<Mesh> make_palm(FigureSide side);
// One link of a finger: from its joint at the origin along -Z, with the joint's ball.
std::vector<Mesh> make_finger_link(double length_m, double radius_m);
// Helmet with visor. Origin between the eyes, -Z forward, +Y up.
std::vector<Mesh> make_head();
// A bar of the arm or the body: from the origin along -Z, a collar at each end.
std::vector<Mesh> make_limb(double length_m, double radius_m);
// Chest with shoulders. Origin at the base of the neck, -Z forward, +Y up.
std::vector<Mesh> make_chest();
// Controller of the wand kind. Origin in the middle of the grip, -Z where it points, +Y its pad.
std::vector<Mesh> make_controller();

}  // namespace handhold

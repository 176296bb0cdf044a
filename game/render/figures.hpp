#pragma once

#include <vector>

#include "game/render/figure_kit.hpp"

// The robot's head, and what it holds: pictures only, no colliders. Its hands are in
// robot_hand.hpp, the rest of it in robot_body.hpp.
namespace handhold {

// Helmet with visor. Origin between the eyes, -Z forward, +Y up.
FigureKit build_head();
// Controller of the wand kind. Origin in the middle of the grip, -Z where it points, +Y its pad.
std::vector<Mesh> make_controller();

}  // namespace handhold

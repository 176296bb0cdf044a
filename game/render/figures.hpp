#pragma once

#include <vector>

#include "game/render/figure_kit.hpp"

// The robot's head, and what it holds: pictures only, no colliders. Its hands are in
// robot_hand.hpp, the rest of it in robot_body.hpp.
namespace handhold {

// Helmet with visor. Origin between the eyes, -Z forward, +Y up.
FigureKit build_head();
// Controller of the wand kind. Origin in the middle of the grip, -Z where it points, +Y its pad.
struct WandMeshes {
    std::vector<Mesh> body, trigger, squeeze, pad;  // what moves, apart
};
WandMeshes make_wand();
inline const Vec3 k_wand_pin_m(0.0, -0.006, -0.058);  // its trigger's
inline const Vec3 k_wand_pad_m(0.0, 0.0175, -0.058);  // its pad's middle

}  // namespace handhold

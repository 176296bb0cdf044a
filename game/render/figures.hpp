#pragma once

#include <vector>

#include "game/render/figure_kit.hpp"

// The robot's head and the controller in its hand, for rendering only (no colliders). For its hands
// see robot_hand.hpp, for its other parts robot_body.hpp.
namespace handhold {

// Helmet with visor. Origin between the eyes, -Z forward, +Y up.
FigureKit build_head();
// A wand controller. Origin at the grip's centre, -Z the pointing direction, +Y the pad's side.
struct WandMeshes {
    std::vector<Mesh> body, trigger, squeeze, pad;  // moving parts are separate
};
WandMeshes make_wand();
inline const Vec3 k_wand_pin_m(0.0, -0.006, -0.058);  // pivot of the trigger
inline const Vec3 k_wand_pad_m(0.0, 0.0175, -0.058);  // centre of the pad

}  // namespace handhold

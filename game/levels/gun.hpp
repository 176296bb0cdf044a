#pragma once

#include "game/levels/station.hpp"
#include "game/scene/scene_file.hpp"

// The game's gun: a body with authored grips. Talk row 10.
namespace handhold {

// Frame: -Z is the muzzle's direction, +Y is up, x = 0 is the plane of symmetry, and the origin is
// where the handle meets the body.
struct GunModel {
    SceneShape shape;  // compound of convex parts; handle and fore-end match the visual
    double mass_kg = 1.0;
    Structure visual;
    std::vector<SceneGrip> grips;  // "handle" and "fore_end", for either hand
};
GunModel make_gun();

}  // namespace handhold

#pragma once

#include "game/levels/station.hpp"
#include "game/scene/scene_file.hpp"

// A gun of the game's own: something that is held in one way. Talk row 10.
namespace handhold {

// Its frame: -Z where it points, +Y up, the plane x = 0 its middle, the origin where the handle
// meets the rest.
struct GunModel {
    SceneShape shape;  // a compound of convex parts; handle and fore-end as they are seen
    double mass_kg = 1.0;
    Structure visual;
    std::vector<SceneGrip> grips;  // "handle" and "fore_end", for either hand
};
GunModel make_gun();

}  // namespace handhold

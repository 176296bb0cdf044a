#pragma once

#include "game/scene/scene.hpp"
#include "systems/frame.hpp"

namespace handhold {

// Moves the colliders of `caches` to the present poses of everything in the scene. Call it before
// queries between two frames: the caches may have been used for another world. step_frame does it
// for itself.
void place_scene(const Scene& scene, FrameCaches& caches);

}  // namespace handhold

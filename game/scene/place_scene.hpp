#pragma once

#include "game/scene/scene.hpp"
#include "systems/frame/frame.hpp"

namespace handhold {

// Moves the colliders of `caches` to the scene's current poses. Call it before queries between two
// frames, because the caches may have been used for another world. step_frame does not need it.
void place_scene(const Scene& scene, FrameCaches& caches);

}  // namespace handhold

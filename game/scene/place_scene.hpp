#pragma once

#include "game/scene/scene.hpp"
#include "systems/frame.hpp"

namespace handhold {

// Brings the collision world of `caches` to where everything in the scene is now, for questions
// between two frames: whoever asks then sees the world alone, not what the caches were last used
// for. Frames do the same for themselves.
void place_scene(const Scene& scene, FrameCaches& caches);

}  // namespace handhold

#pragma once

#include "game/scene/scene.hpp"
#include "game/session/session_script.hpp"

namespace handhold {

// A bay with a rail and distant free bodies, with distance grab on (game/assets/reach.json). The
// caller must add its grip meshes (add_grip_meshes).
Scene make_reach_scene();

// The session of the reach scene. A canister is pulled from two metres away and taken. A safe is
// too heavy and stays. A ball is released on its way and flies past. Then the hands are pulled
// apart on one rail and pushed into a slab, where ghosts show the tracked hands.
SessionScript reach_script();

}  // namespace handhold

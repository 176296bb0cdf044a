#pragma once

#include "game/scene/scene.hpp"
#include "game/session/session_script.hpp"

namespace handhold {

// A bay with a rail and distant free bodies, with distance grab on (game/assets/reach.json). The
// caller must add its grip meshes (add_grip_meshes).
Scene make_reach_scene();

// The session of the reach scene. The right hand pulls a canister from two metres away and takes
// it. It pulls at a safe, which is too heavy and stays. It opens while a ball is on its way, so the
// ball flies past. Then both hands hold one rail and are tracked too far apart, and the right hand
// is pushed into a slab; ghosts show the tracked hands.
SessionScript reach_script();

}  // namespace handhold

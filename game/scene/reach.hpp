#pragma once

#include "game/scene/scene.hpp"
#include "game/session/session_script.hpp"

namespace handhold {

// A bay with a rail and things that float far off, with the distance grab on (game/assets/
// reach.json); its grip meshes are made by whoever asks for it.
Scene make_reach_scene();

// A canister is pulled from two metres off and taken, a safe is too heavy and stays, a ball is let
// go on its way and flies past; then hands are pulled apart on one rail and pushed into a slab,
// and ghosts show where they are.
SessionScript reach_script();

}  // namespace handhold

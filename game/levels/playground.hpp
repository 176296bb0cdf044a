#pragma once

#include "game/scene/scene.hpp"
#include "game/session/session_script.hpp"

// The scene `playground` (game/assets/playground.json) and its session: a lever, a drawer, a
// latched door, a valve, a cable, a gun, and a rock that does not fit its gap.
namespace handhold {

Scene make_playground_scene();
SessionScript playground_script();

}  // namespace handhold

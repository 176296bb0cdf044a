#pragma once

#include "game/scene/scene.hpp"
#include "game/session/session_script.hpp"

// The scene `playground` (game/assets/playground.json) and the session that shows it: a lever, a
// drawer, a latched door, a valve, a cable and a rock that does not fit its gap.
namespace handhold {

Scene make_playground_scene();
SessionScript playground_script();

}  // namespace handhold

#pragma once

#include "game/scene/scene.hpp"

namespace handhold {

// A round hall of 40 m along Z with holds, two moving platforms, two goals and one disc, for two
// teams of up to four players: see game/arena/arena_game.hpp. Eight spawns, blue and orange in
// turn.
Scene make_arena_scene();

}  // namespace handhold

#pragma once

#include "systems/rigs/body_clips.hpp"

namespace handhold {

// The clips of the game's players: game/assets/body_clips.json.
BodyClips game_body_clips();

}  // namespace handhold

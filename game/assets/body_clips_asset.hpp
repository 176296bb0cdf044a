#pragma once

#include "systems/rigs/body_clips.hpp"

namespace handhold {

// The clips that the game's players have: game/assets/body_clips.json.
BodyClips game_body_clips();

}  // namespace handhold

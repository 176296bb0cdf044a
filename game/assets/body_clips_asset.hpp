#pragma once

#include <handhold/handhold.hpp>

namespace handhold {

// Loads the additive clips of the game's players, game/assets/body_clips.json, into a world.
void load_game_body_clips(hh::World& world);

}  // namespace handhold

#pragma once

#include "game/climber/climber_steer.hpp"

namespace handhold {

// A decision of a climber who plays for a team (game/arena/arena_game.hpp): the team's nearest
// player fetches the disc, carries it towards the other goal by jets and throws it; the one nearest
// to the own goal guards it; others wait half way for a loose disc. Precondition: the sight has an
// arena, the task a team.
void play_disc(const ClimberMind& mind);

}  // namespace handhold

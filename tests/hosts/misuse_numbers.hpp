#pragma once

#include <handhold/handhold.h>

#include "misuse.hpp"

namespace misuse {

// Numbers of any kind in every place that takes one. The call may succeed; the world must go on.
void misuse_numbers(hh_world* world, hh_body body, hh_body kinematic, hh_player player, Rng& rng);
// Steps with samples and commands of any kind.
void step_with_anything(hh_world* world, hh_player player, Rng& rng);
// Restores snapshots with a wrong bit or a missing end: each is refused and changes nothing.
void damage_snapshots(hh_world* world, Rng& rng);

}  // namespace misuse

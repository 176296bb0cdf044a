#pragma once

#include "components/body_part.hpp"
#include "components/body_tuning.hpp"
#include "components/player.hpp"
#include "systems/body/shared/body_view.hpp"

namespace handhold {

// Returns the arms, spine and legs that would be shown if head and hands had never moved. Depends
// on its arguments only: no lag, no swing, no trunk that the hands pull, no contact with surfaces,
// no clips. `tuning`: for a player of scale 1; the function scales it.
GrippableBody memoryless_body(const PlayerOrigin& origin, const TrackedBody& body,
                              const ArmTuning& tuning);

}  // namespace handhold

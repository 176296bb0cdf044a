#pragma once

#include <array>

#include "components/arm.hpp"
#include "components/body_part.hpp"
#include "components/body_tuning.hpp"
#include "components/player.hpp"
#include "systems/body/shared/body_view.hpp"

namespace handhold {

// Returns the arms, spine and legs that would be shown if head and hands had never moved. Depends
// on its arguments only: no lag, no swing, no trunk that the hands pull, no contact with surfaces,
// no clips. Arms with ArmGoal::rest hang beside the trunk. `goals`: by HandSide. `tuning`: of a
// player of this scale.
GrippableBody memoryless_body(const PlayerOrigin& origin, TrackedBody body,
                              const std::array<ArmGoal, k_hand_count>& goals,
                              const ArmTuning& tuning);

}  // namespace handhold

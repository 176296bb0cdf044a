#pragma once

#include "components/body_part.hpp"
#include "components/body_tuning.hpp"
#include "components/player.hpp"
#include "systems/body/shared/body_view.hpp"

namespace handhold {

// Arms, spine and legs as they would be shown if head and hands had never moved: a pure function of
// its arguments. Nothing lags, swings or hangs from the hands, and surfaces beside the body and
// clips have no influence. `tuning`: for a scale of 1.
GrippableBody memoryless_body(const PlayerOrigin& origin, const TrackedBody& body,
                              const ArmTuning& tuning);

}  // namespace handhold

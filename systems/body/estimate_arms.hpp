#pragma once

#include "components/arm.hpp"
#include "components/body_tuning.hpp"
#include "components/grab.hpp"
#include "components/hand.hpp"
#include "components/player.hpp"
#include "components/tracking.hpp"
#include "engine/ecs/column.hpp"

namespace handhold {

struct EstimateArmsIo {
    double dt_s;                           // in: > 0
    const Column<PlayerOrigin>& origin;    // in
    const Column<HeadTracking>& head;      // in
    const Column<BodyMeasures>& measures;  // in: every player
    const Column<HandOwner>& owner;        // in
    const Column<PalmPose>& palm;          // in: shown hands
    Column<ArmMemory>& memory;             // in/out
    Column<ArmEstimate>& estimate;         // out
};

// Estimates every player's chest, shoulders and elbow directions from head and hands (talk rows 19
// to 22; the steps are in systems/body/shared). Works in play space, so that players may hang
// upside down or turn with a ship. If the head jumps, the state is re-initialised; if a hand jumps,
// that arm's state.
void estimate_arms(const EstimateArmsIo& io, const ArmTuning& tuning);

}  // namespace handhold

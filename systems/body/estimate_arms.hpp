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
    const Column<BodyMeasures>& measures;  // in: has every player
    const Column<HandOwner>& owner;        // in
    const Column<HandTracking>& hand;      // in: state; hands that are not in it are tracked
    const Column<Grab>& grab;              // in: kind; hands that are not in it hold nothing
    Column<PalmPose>& palm;                // in: shown hands; out: lost ones, and those that return
    Column<ArmMemory>& memory;             // in/out
    Column<ArmEstimate>& estimate;         // out
};

// Estimates every player's chest, shoulders and elbow directions from head and hands (talk rows 19
// to 22; the steps are in systems/body/shared). Works in play space, so that players may hang
// upside down or turn with a ship. If the head jumps, the state is re-initialised; if a hand jumps,
// only that arm's state is.
//
// A hand that is lost or was never tracked, and grips nothing, goes to a rest pose in the frame of
// the player's view at k_rest_speed_mps, and comes back like that (shared/rest_hand.hpp). The chest
// sees it there, so that the place where the hand was lost turns nobody. Such an arm is at most
// k_rest_reach times as long as its bones. Hands that grip and inferred hands are shown as given.
void estimate_arms(const EstimateArmsIo& io, const ArmTuning& tuning);

}  // namespace handhold

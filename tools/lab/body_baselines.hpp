#pragma once

#include "components/arm.hpp"
#include "engine/math/math.hpp"

// Baselines for the runtime's estimate of chest and arms. Both take the hands from
// `out.arms[].hand_ps`, as estimate_arms does, and keep no state.
namespace handhold::lab {

// The chest has the head's yaw, the shoulders are fixed to it, elbows point down.
void estimate_naive(const Pose& head_ps, const BodyMeasures& measures, ArmEstimate& out);

// The talk's rows 19 to 22 with plausible constants. The chest faces a blend of the head's
// direction and the unit vectors to the hands; a hand's weight fades when it is near or behind. The
// pole is a blend of down-and-back and the wrist's back.
void estimate_as_talked(const Pose& head_ps, const BodyMeasures& measures, ArmEstimate& out);

}  // namespace handhold::lab

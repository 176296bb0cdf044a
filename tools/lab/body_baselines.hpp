#pragma once

#include "components/arm.hpp"
#include "engine/math/math.hpp"

// Baselines for the runtime's estimate of chest and arms. The two functions below take the hands
// from `out.arms[].hand_ps`, as estimate_arms does, and keep no state.
namespace handhold::lab {

// The chest has the head's yaw, the shoulders are fixed to it, elbows point down.
void estimate_naive(const Pose& head_ps, const BodyMeasures& measures, ArmEstimate& out);

// Rows 19 to 22 of the talk, with plausible constants. The chest faces a blend of the head's
// direction and the unit vectors to the hands. A hand's weight fades when the hand is near or
// behind. The elbow's pole is a blend of down-and-back and the direction of the wrist's back.
void estimate_as_talked(const Pose& head_ps, const BodyMeasures& measures, ArmEstimate& out);

}  // namespace handhold::lab

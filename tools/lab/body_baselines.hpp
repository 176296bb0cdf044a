#pragma once

#include "components/arm.hpp"
#include "engine/math/math.hpp"

// Baselines for the runtime's estimate of chest and arms. The two functions below take the hands
// from `out.arms[].hand_ps`, as estimate_arms does, and keep no state.
namespace handhold::lab {

// The chest has the head's yaw, the shoulders are fixed to the chest, and the elbows point down.
void estimate_naive(const Pose& head_ps, const BodyMeasures& measures, ArmEstimate& out);

// Talk rows 19 to 22, with plausible constants. The chest faces a blend of the head's direction and
// the unit vectors to the hands. A hand's weight fades if the hand is near the head or behind it.
// The elbow points to a blend of a rest direction (down, back and a little outward) and the
// direction opposite to the fingers.
void estimate_as_talked(const Pose& head_ps, const BodyMeasures& measures, ArmEstimate& out);

}  // namespace handhold::lab

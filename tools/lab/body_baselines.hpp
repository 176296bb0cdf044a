#pragma once

#include "components/arm.hpp"
#include "engine/math/math.hpp"

// What the runtime's estimate of chest and arms is compared with. Both take the hands from
// `out.arms[].hand_ps`, as estimate_arms does, and remember nothing.
namespace handhold::lab {

// The chest faces where the head does, the shoulders are fixed to it, elbows hang down.
void estimate_naive(const Pose& head_ps, const BodyMeasures& measures, ArmEstimate& out);

// The talk's rows 19 to 22 with sensible constants: the chest faces a blend of head look and the
// unit vectors to the hands, which fade as a hand comes near or goes behind; the pole is a blend of
// down-and-back with the wrist's back.
void estimate_as_talked(const Pose& head_ps, const BodyMeasures& measures, ArmEstimate& out);

}  // namespace handhold::lab

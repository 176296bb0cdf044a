#pragma once

#include "components/hand_rig.hpp"

namespace handhold {

// The built-in robot hand: five fingers in the order of FingerName, adult size (0.18 m from the
// wrist to the middle finger's skin), joints with WebXR's names. The left hand is the exact mirror
// image of the right one.
HandRig builtin_hand_rig(HandSide side);

}  // namespace handhold

#pragma once

#include "components/hand_rig.hpp"

namespace handhold {

// The built-in robot hand. It has five fingers in the order of FingerName, and joints with WebXR
// names. It has the size of an adult's hand. The left hand is the exact mirror image of the right
// one.
HandRig builtin_hand_rig(HandSide side);

}  // namespace handhold

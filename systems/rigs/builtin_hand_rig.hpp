#pragma once

#include "components/hand_rig.hpp"

namespace handhold {

// The project's own robot hand: five fingers, adult size (0.18 m from the wrist to the skin of the
// middle finger's tip), joints by WebXR's names, fingers in the order of FingerName. The left hand
// is the exact mirror of the right one.
HandRig builtin_hand_rig(HandSide side);

}  // namespace handhold

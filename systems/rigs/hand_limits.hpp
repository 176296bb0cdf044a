#pragma once

#include "components/hand_rig.hpp"

// Joint limits, the same for all hand rigs, because a skin does not determine them. Angles count
// from a straight finger in line with the palm. A thumb's first link counts from a pose slightly
// more open than the rest pose.
namespace handhold {

// Sets lower_rad, upper_rad and rest_rad of all links, range and axis of the opposition (a finger's
// spread, positive towards the thumb's side, on either hand), and the fist.
void set_hand_limits(HandSide side, FingerRig& finger);

// Direction of the thumb's first link at opposition 0, as an angle about the opposition axis: 0
// points out of the thumb's side of the hand, positive turns it towards the palm's side. A sixth of
// a turn.
inline constexpr double k_thumb_below_rad = 1.0471975511965976;

}  // namespace handhold

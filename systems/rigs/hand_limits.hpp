#pragma once

#include "components/hand_rig.hpp"

// Joint limits of all hand rigs, which a skin does not determine. Angles are measured from a
// straight finger in line with the palm; those of a thumb's first link from a slightly more open
// pose than the rest pose.
namespace handhold {

// Sets lower_rad, upper_rad and rest_rad of all links, and a thumb's opposition range and axis.
void set_hand_limits(HandSide side, FingerRig& finger);

// Angle of the thumb's first link at opposition 0, about the opposition axis, from the thumb's side
// of the hand towards the palm's side.
inline constexpr double k_thumb_below_rad = 1.0471975511965976;  // 60 degrees

}  // namespace handhold

#pragma once

#include "components/hand_rig.hpp"

// How far hands of any rig bend: what a skin does not tell. Angles from a straight finger in line
// with the palm; a thumb's first link from where it stands a little more open than at rest.
namespace handhold {

// lower_rad, upper_rad, relaxed_rad of all links; a thumb's opposition range and axis as well.
void set_hand_limits(HandSide side, FingerRig& finger);

// At opposition 0 the thumb's first link lies so far about the axis from the thumb's side of the
// hand towards the palm's.
inline constexpr double k_thumb_below_rad = 1.0471975511965976;  // 60 degrees

}  // namespace handhold

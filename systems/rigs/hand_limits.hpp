#pragma once

#include "components/hand_rig.hpp"

// Joint limits, the same for all hand rigs, because a skin does not determine them. Angles count
// from a straight finger in line with the palm. A thumb's first link counts from a pose slightly
// more open than the rest pose.
namespace handhold {

// Sets lower_rad, upper_rad and rest_rad of all links, and range and axis of the opposition: a
// finger's spread, positive towards the thumb's side, on either hand.
void set_hand_limits(HandSide side, FingerRig& finger);

// Direction of the thumb's first link at opposition 0, as an angle about the opposition axis: 0
// points out of the thumb's side of the hand, positive turns it towards the palm's side. A sixth of
// a turn.
inline constexpr double k_thumb_below_rad = 1.0471975511965976;

// Curl of a fist as a share of the range from open to fully curled.
inline constexpr double k_fist_curl = 0.85;
// Curl of a hinge in a fist, radians.
inline double fist_rad(const FingerRig& finger, std::size_t link) {
    return finger.lower_rad[link] + k_fist_curl * (finger.upper_rad[link] - finger.lower_rad[link]);
}

}  // namespace handhold

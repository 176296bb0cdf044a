#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "components/tracking.hpp"
#include "engine/math/math.hpp"

// Computes the curls of fingers from the joints of hand tracking.
namespace handhold {

// A tracked hand's joints by OpenXR's index (XrHandJointEXT, hh_hand_joint_name), in any space;
// absent: not seen.
inline constexpr std::size_t k_tracked_joint_count = 26;
using TrackedJoints = std::array<std::optional<Vec3>, k_tracked_joint_count>;

// Curl of each finger, [0, 1]; k_unknown_curl for a finger with a joint that is absent or not
// finite.
//
//     curl = sum(bend_j) / sum(fist_j)
//
// bend_j: angle at joint j between the bones before and after it, radians; fist_j: the same angle
// in a fist (set_hand_limits). The joints are the finger's proximal, intermediate and distal
// ones. A thumb has only its proximal and distal ones, because opposition moves its first joint.
FingerCurls finger_curls(const TrackedJoints& joints);

}  // namespace handhold

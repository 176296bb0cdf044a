#pragma once

#include <limits>

#include "components/hand.hpp"
#include "components/hand_surroundings.hpp"
#include "components/tuning.hpp"

// Fits a palm to a surface: moves it into its height and tilt limits and depenetrates it.
// search_grip evaluates candidates with it. Talk row 16.
namespace handhold {

struct PalmFit {
    Pose wrist_bs;  // fitted wrist: within the limits, and depenetrated as far as possible
    double penetration_m = 0.0;  // remaining penetration of the palm; at least 0
    // Remaining penetration of the open fingers; at least 0.
    double finger_penetration_m = 0.0;
};

// Finds the smallest correction of the tracked wrist that brings the palm within its limits over
// `surface`, without penetration:
//
// 1. Limits: moves the palm parallel to the triangle's plane until it is over the triangle, then
//    along the normal into [min_height_m, max_height_m], then tilts it about its centre to at most
//    max_angle_rad.
// 2. Depenetration, if capsules of the palm or of open fingers penetrate: solves in each of at most
//    6 iterations the linearised problem
//      minimise |t|^2 + (arm |r|)^2   subject to   gap_i + a_i . t + b_i . r >= 0
//    where t is the translation and r the rotation vector about the palm's centre, and arm is
//    PalmTuning::rotation_arm_m. gap_i is the distance of one of the palm's spheres from a surface,
//    or the margin to one of the limits; a_i and b_i are its derivatives by t and r.
//
// Open fingers, without the thumb, are part of the palm's collision shape: a finger that closes
// starts there. A fit that penetrates deeper than `max_penetration_m` after 2 iterations is
// abandoned: the result is the best pose so far. Precondition: the hand has meshes, and `surface`
// is on the first mesh.
PalmFit fit_palm(const HandSurroundings& hand, const GripSurface& surface, const PalmTuning& tuning,
                 double max_penetration_m = std::numeric_limits<double>::infinity());

}  // namespace handhold

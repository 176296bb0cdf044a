#pragma once

#include <limits>

#include "components/hand.hpp"
#include "components/hand_surroundings.hpp"
#include "components/tuning.hpp"

// The palm's limits over a surface, and its depenetration: search_grip evaluates candidates with
// it, constrain_palms uses it for the target. Talk row 16.
namespace handhold {

struct PalmFit {
    Pose wrist_bs;                      // within the limits, and depenetrated as far as possible
    double penetration_m = 0.0;         // remaining penetration of the palm; at least 0
    double finger_penetration_m = 0.0;  // of the fingers that are part of its collision shape
    bool is_converged = true;           // false: more iterations would move the wrist
};

struct PalmFitSettings {
    // Warm start: a surface of the same hand from the last frame, or of this frame without its
    // lift. Starts with the correction that was found for it. Null: cold start.
    const GripSurface* last = nullptr;
    int max_iterations = 6;
    // After 2 iterations, abandons a fit that penetrates deeper than this.
    double max_penetration_m = std::numeric_limits<double>::infinity();
    // False: skips the query after the last step if the step is short. The depths are then those
    // before the step, and the fit counts as not converged.
    bool verifies_last_step = true;
};

// The smallest correction of the tracked wrist that holds the palm over `surface` within its limits
// and without penetration:
//
// 1. Limits: along the normal into [min_height_m, max_height_m] + lift_m, then tilted about the
//    palm's centre to at most max_angle_rad.
// 2. Depenetration, if capsules of the palm penetrate: repeated linearised solves for
//      minimise |t|^2 + (arm |r|)^2   subject to   gap_i + a_i . t + b_i . r >= 0
//    where t, r are translation and rotation vector about the palm's centre, arm is
//    PalmTuning::rotation_arm_m, and the gaps are those of the palm's spheres and of the limits.
//
// Fingers with a sample pose in `surface` are part of the palm's collision shape. Precondition: the
// hand has meshes, and `surface` is on the first one.
PalmFit fit_palm(const HandSurroundings& hand, const GripSurface& surface, double lift_m,
                 const PalmTuning& tuning, const PalmFitSettings& settings = {});

}  // namespace handhold

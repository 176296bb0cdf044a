#pragma once

#include "engine/math/math.hpp"

namespace handhold {

// Accepted measures of a T-pose or A-pose: height of the eyes above the floor, and arm span
// (distance between the wrists with the arms held level). In the player's metres, as all lengths of
// a calibration: those of the world over PlayerOrigin::scale.
struct TPoseRange {
    static constexpr double k_min_eyes_m = 0.3;
    static constexpr double k_max_eyes_m = 2.6;
    static constexpr double k_min_span_m = 0.6;
    static constexpr double k_max_span_m = 2.4;
};

// Progress of a held T-pose or A-pose. Written by calibrate_players.
struct Calibration {
    // True: the player was measured; stays true until PlayerCommands::calibrate ends.
    bool done = false;
    double held_s = 0.0;    // time for which the pose has been held; [0, CalibrationTuning::hold_s]
    double eyes_s_m = 0.0;  // time integral of the eyes' height over held_s
    double span_s_m = 0.0;  // time integral of the arm span over held_s
    // Positions of the hands when the pose began.
    Vec3 left_ps = Vec3::Zero();
    Vec3 right_ps = Vec3::Zero();
};

// Whether poses within TPoseRange, held for `held_s`, can have these sums.
inline bool has_possible_sums(const Calibration& calibration) {
    constexpr double k_rounding = 1e-9;
    const auto is_sum_of = [&](double sum_s_m, double min_m, double max_m) {
        return sum_s_m >= (min_m - k_rounding) * calibration.held_s - k_rounding &&
               sum_s_m <= (max_m + k_rounding) * calibration.held_s + k_rounding;
    };
    return is_sum_of(calibration.eyes_s_m, TPoseRange::k_min_eyes_m, TPoseRange::k_max_eyes_m) &&
           is_sum_of(calibration.span_s_m, TPoseRange::k_min_span_m, TPoseRange::k_max_span_m);
}

}  // namespace handhold

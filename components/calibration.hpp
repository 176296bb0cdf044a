#pragma once

#include "engine/math/math.hpp"

namespace handhold {

// What a T-pose may be, metres: eyes above the floor, from wrist to wrist.
struct TPoseRange {
    static constexpr double k_min_eyes_m = 0.3;
    static constexpr double k_max_eyes_m = 2.6;
    static constexpr double k_min_span_m = 0.6;
    static constexpr double k_max_span_m = 2.4;
};

// A T-pose that is being held. Written by calibrate_players.
struct Calibration {
    bool done = false;      // measured since it was last asked for
    double held_s = 0.0;    // [0, CalibrationTuning::hold_s]
    double eyes_s_m = 0.0;  // sums over that time: of the eyes' height
    double span_s_m = 0.0;  // and from wrist to wrist
    // Where the hands were when it began.
    Vec3 left_ps = Vec3::Zero();
    Vec3 right_ps = Vec3::Zero();
};

}  // namespace handhold

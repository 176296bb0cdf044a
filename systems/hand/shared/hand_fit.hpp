#pragma once

#include <array>
#include <cstddef>

#include "components/hand.hpp"
#include "components/hand_surroundings.hpp"
#include "components/tuning.hpp"

namespace handhold {

// Weights are in units of w_sync, angles are multiplied by levers: everything is in square metres.
struct FitTuning {
    double turn_arm_m = 0.08;
    double close = 0.0005;
    double alike = 0.0015;
    double alike_free = 0.02;
    double couple = 0.001;
    double rest = 0.00002;
    double oppose = 0.02;
    double tip = 0.02;
    double touch = 0.05;
    double first = 0.005;
    double thumb_close = 0.0;
    double last = 0.0;
    double contact = 2000.0;
    double limit = 500.0;
    double style = 0.3;
    double max_apart_rad = 1.6;
    double max_fold_rad = 2.85;
    double max_height_m = 0.015;
    double max_angle_rad = 0.44;
    double height_weight = 20.0;
    double clear_m = 0.0003;
    int rounds = 6;
};

struct HandPose {
    Pose wrist_bs;
    std::array<FingerAngles, k_finger_count> fingers;
};

struct HandFitGoal {
    std::array<bool, k_finger_count> touches = {};  // the closing found a contact
    std::array<bool, k_finger_count> is_clear = {};  // the first pose is outside
    std::array<bool, k_finger_count> is_fixed = {};  // authored
};

struct HandFit {
    HandPose pose;
    double penetration_m = 0.0;
    double merit = 0.0;
};

HandFit fit_hand(const HandSurroundings& hand, const GripSurface& surface, const HandPose& first,
                 const HandFitGoal& goal, const PalmTuning& palm, const FitTuning& tuning);

}  // namespace handhold

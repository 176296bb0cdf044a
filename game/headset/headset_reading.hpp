#pragma once

#include <array>
#include <optional>

#include "components/tracking.hpp"
#include "engine/math/math.hpp"

namespace handhold {

// State of one hand at one time, as the headset's runtime reports it. Poses are in play space;
// nullopt: not tracked. Grip and aim pose are OpenXR's. The grip's origin is the palm's centre on
// the handle; -Z points along the handle to the thumb, +X into the right palm or out of the left
// one.
struct HandReading {
    std::optional<Pose> grip_ps;
    std::optional<Pose> aim_ps;
    std::optional<Pose> palm_ps;  // grip pose, turned: -Z along the hand to the fingers
    // from finger tracking: -Z to the fingers, +Y out of the back of the hand
    std::optional<Pose> wrist_ps;
    double curl = 0.0;              // from finger tracking: 0 flat, 1 a fist
    double squeeze = 0.0;           // [0, 1]
    double trigger = 0.0;           // [0, 1]
    std::array<double, 2> stick{};  // right and forward, each [-1, 1]
    bool brake = false;
    bool calibrate = false;
};

struct HeadsetReading {
    std::optional<Pose> head_ps;                  // between the eyes
    std::array<HandReading, k_hand_count> hands;  // by HandSide
};

// A short vibration of a controller.
struct HapticPulse {
    double amplitude = 0.0;   // [0, 1]
    double duration_s = 0.0;  // 0: none
};

}  // namespace handhold

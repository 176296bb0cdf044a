#pragma once

#include <array>
#include <optional>

#include "components/tracking.hpp"
#include "engine/math/math.hpp"

namespace handhold {

// A runtime's reading of one hand at one time, in the space of its tracking. An absent pose is not
// tracked. Grip and aim poses are OpenXR's: the grip's origin is the palm's centre on the handle,
// -Z points along the handle to the thumb, +X into the right palm and out of the left one.
struct HandReading {
    std::optional<Pose> grip_ps;
    std::optional<Pose> aim_ps;
    std::optional<Pose> palm_ps;  // grip pose rotated: -Z along the hand to the fingers
    std::optional<Pose>
        wrist_ps;          // wrist of tracked fingers; -Z: to the fingers, +Y: the back of the hand
    double curl = 0.0;     // curl of tracked fingers; 0: flat, 1: a fist
    double squeeze = 0.0;  // [0, 1]
    double trigger = 0.0;  // [0, 1]
    std::array<double, 2> stick{};  // right and forward, each [-1, 1]
    bool brake = false;
    bool calibrate = false;
};

struct HeadsetReading {
    std::optional<Pose> head_ps;                  // point between the eyes
    std::array<HandReading, k_hand_count> hands;  // indexed by HandSide
};

// A short vibration of a controller.
struct HapticPulse {
    double amplitude = 0.0;   // [0, 1]
    double duration_s = 0.0;  // 0: none
};

}  // namespace handhold

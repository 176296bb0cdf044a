#pragma once

#include <array>
#include <optional>

#include <handhold/handhold.hpp>

#include "game/session/finger_curls.hpp"

namespace handhold {

// Poses of one hand, by the device that gives them.
struct HandPoses {
    std::optional<hh::Pose> grip_ps;   // pose of a controller
    std::optional<hh::Pose> palm_ps;   // grip pose rotated: -Z along the hand to the fingers
    std::optional<hh::Pose> wrist_ps;  // tracked wrist; -Z to the fingers, +Y the back of the hand
};

// A runtime's reading of one hand at one time, in the space of its tracking. An absent pose is not
// tracked. Grip and aim poses are OpenXR's: the grip's origin is the palm's centre on the handle,
// -Z points along the handle to the thumb, +X into the right palm and out of the left one.
struct HandReading {
    std::optional<hh::Pose> grip_ps;
    std::optional<hh::Pose> aim_ps;
    std::optional<hh::Pose> palm_ps;
    std::optional<hh::Pose> wrist_ps;
    HandPoses guesses;  // poses that the runtime infers, because it does not see the device
    hh_finger_curls curls = k_curls_unknown;  // curls of tracked fingers
    double curl = 0.0;              // curl of tracked fingers; 0: flat, 1: a fist, NaN: not seen
    double squeeze = 0.0;           // [0, 1]
    double trigger = 0.0;           // [0, 1]
    std::array<double, 2> stick{};  // right and forward, each [-1, 1]
    bool brake = false;
    bool calibrate = false;
};

struct HeadsetReading {
    std::optional<hh::Pose> head_ps;   // point between the eyes
    bool is_head_inferred = false;     // the runtime guesses the head's position
    std::array<HandReading, 2> hands;  // indexed by hh::Side
};

// A short vibration of a controller.
struct HapticPulse {
    double amplitude = 0.0;   // [0, 1]
    double duration_s = 0.0;  // 0: none
};

}  // namespace handhold

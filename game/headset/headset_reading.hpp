#pragma once

#include <array>
#include <optional>

#include "components/tracking.hpp"
#include "engine/math/math.hpp"

namespace handhold {

// What a headset's runtime says of one hand at one time, in the space of its tracking. A pose that
// is absent is not tracked. Grip and aim as OpenXR defines them: the grip's origin is the palm's
// centre on the handle, its -Z goes along the handle to the thumb, its +X into the right hand's
// palm and out of the left one's.
struct HandReading {
    std::optional<Pose> grip_ps;
    std::optional<Pose> aim_ps;
    std::optional<Pose> palm_ps;    // as the grip, but turned: -Z along the hand to its fingers
    std::optional<Pose> wrist_ps;   // of tracked fingers: -Z to them, +Y the back of the hand
    double curl = 0.0;              // of tracked fingers: 0 flat, 1 a fist
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

// A short shake of a controller.
struct HapticPulse {
    double amplitude = 0.0;   // [0, 1]
    double duration_s = 0.0;  // 0: none
};

}  // namespace handhold

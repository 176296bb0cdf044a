#pragma once

#include <array>

#include "components/tracking.hpp"
#include "components/tuning.hpp"
#include "game/desktop/play_settings.hpp"
#include "game/headset/headset_reading.hpp"

// Converts readings of a headset to the game's input: tracking samples (as from recordings, or from
// keyboard and mouse) and player commands.
namespace handhold {

// Wrist pose in OpenXR's grip frame. The hand holds the controller's handle like a default
// HandleGrip.
Pose hand_in_grip(HandSide side, const HandTuning& tuning);
// Wrist pose in OpenXR's palm frame: origin at the palm's centre, on the skin; -Z along the hand to
// the fingers.
Pose hand_in_palm(HandSide side, const HandTuning& tuning);

// Curl of a finger: 0 if it is in line with the hand, 1 if it points back to the wrist.
double finger_curl(const Vec3& wrist, const Vec3& knuckle, const Vec3& tip);

// State kept from one reading to the next.
struct HeadsetMemory {
    std::array<bool, k_hand_count> grabs{};
    bool turned = false;  // the current push of the stick has made its snap turn
};

// A hand closes when squeeze, trigger or finger curl exceeds 0.55, and opens when none exceeds
// 0.35. Finger curl counts only for a hand without palm and grip pose. The hand's pose comes from
// the palm pose, else the grip pose, else the tracked wrist. If none is tracked, the pose is NaN
// and the hand stays open or closed: losing sight of a hand does not open it.
//
// `own_joints`: controller-to-hand joints of a profile, by HandSide, instead of the default ones.
// The grip pose then precedes the palm pose, and is itself the controller's pose.
TrackingSample read_headset(const HeadsetReading& reading, double t_s, const HandTuning& tuning,
                            HeadsetMemory& memory,
                            const std::array<Pose, k_hand_count>* own_joints = nullptr);

// Right stick: turns, in steps or smoothly. Left stick: thrust of the jets, relative to the head.
// Either brake button brakes. Both calibrate buttons together start a calibration.
PlayerCommands read_headset_commands(const HeadsetReading& reading, TurnKind turn,
                                     HeadsetMemory& memory);

}  // namespace handhold

#pragma once

#include <array>

#include <handhold/handhold.hpp>

#include "game/devices/headset_reading.hpp"
#include "game/devices/play_settings.hpp"
#include "game/session/hand_pose.hpp"

// Converts readings of a headset's runtime to the game's input: tracking samples, as recordings and
// the emulated body of keyboard and mouse give them, and commands from sticks and buttons.
namespace handhold {

// Wrist in OpenXR's grip frame, which lies in the controller's handle. The palm is on the handle as
// HandleGrip says.
hh::Pose hand_in_grip(hh::Side side, hh::Vec3 palm_center_m);
// Wrist in OpenXR's palm frame. Its origin is the palm's centre on the skin, its axes are the
// hand's.
hh::Pose hand_in_palm(hh::Side side, hh::Vec3 palm_center_m);

// Curl of a finger: 0 in line with the hand, 1 if it points back at the wrist. NaN, which stands
// for unknown, if the points are no finger's: some runtimes report zeros for joints that they do
// not see.
double finger_curl(const hh::Vec3& wrist, const hh::Vec3& knuckle, const hh::Vec3& tip);

// State between readings.
struct HeadsetMemory {
    std::array<bool, 2> grabs{};
    std::array<double, 2> curls{};  // HandReading::curl, where last known
    // HandReading::curls, each where last known; unknown while a controller is held.
    std::array<hh_finger_curls, 2> fingers = {k_curls_unknown, k_curls_unknown};
    bool turned = false;  // one snap turn per push of the stick
};

// A hand closes when squeeze, trigger or finger curl exceeds 55 %, and opens when all are below 35
// %. The palm pose is preferred to the grip pose, and both to tracked fingers. A device that is not
// tracked keeps its button: losing sight of a hand does not open it. So does a hand whose fingers
// are not seen. A pose that the runtime infers is given as hand_inferred, with the button as it
// was; any measured pose of the hand is preferred to it. The web page does the same
// (game/web/demo/devices.js).
//
// `own_joints`: controller-to-hand poses of a controller profile, which replace hand_in_grip,
// hand_in_palm and the tuning's. The grip pose is then preferred to the palm pose, and is used as
// the controller's pose.
hh::Sample read_headset(const HeadsetReading& reading, double t_s, const HandShape& shape,
                        HeadsetMemory& memory, const std::array<hh::Pose, 2>* own_joints = nullptr);

// Right stick: snap or smooth turns. Left stick, relative to the head: thrusters. Either brake
// button brakes; both calibrate buttons together request calibration.
hh_commands read_headset_commands(const HeadsetReading& reading, TurnKind turn,
                                  HeadsetMemory& memory);

}  // namespace handhold

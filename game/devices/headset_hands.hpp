#pragma once

#include <array>

#include <handhold/handhold.hpp>

#include "game/devices/headset_reading.hpp"
#include "game/devices/play_settings.hpp"
#include "game/session/hand_pose.hpp"

// Converts readings of a headset's runtime to the game's input: tracking samples, as recordings and
// the emulated body of keyboard and mouse give them, and commands from sticks and buttons.
namespace handhold {

// Pose of the wrist in OpenXR's grip frame, whose origin is in the controller's handle. The default
// HandleGrip says how the palm lies on the handle.
hh::Pose hand_in_grip(hh::Side side, hh::Vec3 palm_center_m);
// Pose of the wrist in OpenXR's palm frame. The frame's origin is the palm's centre on the skin; -Z
// points along the hand to the fingers, +X into the right palm and out of the left one.
hh::Pose hand_in_palm(hh::Side side, hh::Vec3 palm_center_m);

// Curl of a finger: 0 in line with the hand, 1 if it points back at the wrist. NaN, which stands
// for unknown, if the points are not those of a finger: some runtimes report zeros for joints that
// they do not see.
double finger_curl(const hh::Vec3& wrist, const hh::Vec3& knuckle, const hh::Vec3& tip);

// State between readings.
struct HeadsetMemory {
    std::array<bool, 2> grabs{};
    std::array<double, 2> curls{};  // last known HandReading::curl; 0 while a controller is held
    // Last known curl of each finger (HandReading::curls); unknown while a controller is held.
    std::array<hh_finger_curls, 2> fingers = {k_curls_unknown, k_curls_unknown};
    bool turned = false;  // whether the current push of the stick has made its one snap turn
};

// A hand closes when squeeze, trigger or finger curl exceeds 55 %, and opens when none of them
// exceeds 35 %. The palm pose is preferred to the grip pose, and both to the tracked wrist. A hand
// that is not tracked stays closed or open: losing sight of a hand does not open it. A tracked hand
// whose fingers are not seen keeps its last curl. A pose that the runtime infers is given as
// hand_inferred, and does not close or open the hand; any measured pose of the hand is preferred to
// it. The web page does the same (game/web/demo/devices.js).
//
// `own_joints`: controller-to-hand poses of a controller profile. They replace hand_in_grip and
// HandShape::in_controller, and the grip pose is then preferred to the palm pose.
hh::Sample read_headset(const HeadsetReading& reading, double t_s, const HandShape& shape,
                        HeadsetMemory& memory, const std::array<hh::Pose, 2>* own_joints = nullptr);

// Right stick: snap or smooth turns. Left stick, relative to the head: thrusters. Either brake
// button brakes; both calibrate buttons together request calibration.
hh_commands read_headset_commands(const HeadsetReading& reading, TurnKind turn,
                                  HeadsetMemory& memory);

}  // namespace handhold

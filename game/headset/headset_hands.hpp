#pragma once

#include <array>

#include "components/tracking.hpp"
#include "components/tuning.hpp"
#include "game/desktop/play_settings.hpp"
#include "game/headset/headset_reading.hpp"

// What a headset's runtime says, as the input of the game: the samples that recordings and the
// emulated body of keyboard and mouse give, and what sticks and buttons ask for.
namespace handhold {

// The wrist in OpenXR's grip frame, which lies in a controller's handle: the palm's skin is on the
// handle as HandleGrip says, as with WebXR's profiles.
Pose hand_in_grip(HandSide side, const HandTuning& tuning);
// The wrist in OpenXR's palm frame, whose origin is the palm's centre, on its skin, and which knows
// the hand's own axis.
Pose hand_in_palm(HandSide side, const HandTuning& tuning);

// 0 for a finger in line with the hand, 1 for one whose tip has come back to point at the wrist.
double finger_curl(const Vec3& wrist, const Vec3& knuckle, const Vec3& tip);

// State kept from one reading to the next.
struct HeadsetMemory {
    std::array<bool, k_hand_count> grabs{};
    bool turned = false;  // one snap turn a push of the stick
};

// A hand closes from 55 % of squeeze, trigger or curled fingers on until all are below 35 %. A
// palm counts before a grip, and both before tracked fingers; what is not tracked has a pose of NaN
// and keeps its button as it was: losing sight of a hand does not open it.
//
// `own_joints`: the joint of a controller's profile, in place of the ones above and of Tuning's;
// a grip then counts before a palm, and is itself the controller's pose.
TrackingSample read_headset(const HeadsetReading& reading, double t_s, const HandTuning& tuning,
                            HeadsetMemory& memory,
                            const std::array<Pose, k_hand_count>* own_joints = nullptr);

// Right stick: turns, by steps or smoothly. Left stick and head: where the jets push. Either brake
// brakes; both calibrate buttons together ask for calibration.
PlayerCommands read_headset_commands(const HeadsetReading& reading, TurnKind turn,
                                     HeadsetMemory& memory);

}  // namespace handhold

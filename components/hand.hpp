#pragma once

#include <array>
#include <cstdint>

#include "components/hand_rig.hpp"
#include "engine/ecs/entity.hpp"
#include "engine/math/math.hpp"

// How hands are shown: fitted to what they hold. None of it ever moves the player.
namespace handhold {

// The wrist as it is shown, at the end of the frame. Arms reach for it. Written by constrain_palms.
struct PalmPose {
    Pose pose_ws;
};

// How the hand's fingers are shown. Written by sweep_fingers and pose_thumb.
struct FingerPose {
    std::array<FingerAngles, k_finger_count> fingers;  // by place in HandRig::fingers
};

}  // namespace handhold

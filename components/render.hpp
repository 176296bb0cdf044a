#pragma once

#include <array>

#include "components/arm.hpp"
#include "components/grab.hpp"
#include "components/hand_rig.hpp"
#include "components/spine.hpp"
#include "engine/math/math.hpp"

// What a host draws. publish_pose writes head and hands, publish_body writes arms and spine.
namespace handhold {

struct RenderPose {
    struct Hand {
        Pose tracked_ws;                  // hand pose from the controller
        Pose shown_ws;                    // drawn hand: at its anchor while it grips
        Vec3 ray_from_ws = Vec3::Zero();  // the palm's ray
        Vec3 ray_to_ws = Vec3::Zero();
        GripKind grip = GripKind::none;
        std::array<FingerAngles, k_finger_count> fingers;  // by index in HandRig::fingers
    };
    Pose head_ws;
    Vec3 head_center_ws = Vec3::Zero();    // centre of the head's collider
    std::array<Hand, k_hand_count> hands;  // by HandSide
    double push_back_m = 0.0;              // player displacement by this frame's contacts
    ArmPose arms;                          // hand_ws equals shown_ws exactly
    SpinePose spine;
};

}  // namespace handhold

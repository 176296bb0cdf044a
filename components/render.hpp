#pragma once

#include <array>

#include "components/arm.hpp"
#include "components/grab.hpp"
#include "components/hand_rig.hpp"
#include "components/spine.hpp"
#include "engine/math/math.hpp"

// World poses that a host draws. publish_pose writes head and hands; publish_body writes arms and
// spine.
namespace handhold {

struct RenderPose {
    struct Hand {
        Pose tracked_ws;                  // tracked hand
        Pose shown_ws;                    // hand to draw; at its anchor while it grips
        Vec3 ray_from_ws = Vec3::Zero();  // start and end of the palm ray
        Vec3 ray_to_ws = Vec3::Zero();
        GripKind grip = GripKind::none;
        std::array<FingerAngles, k_finger_count> fingers;  // indexed by index in HandRig::fingers
    };
    Pose head_ws;
    Vec3 head_center_ws = Vec3::Zero();    // centre of the head's collider
    std::array<Hand, k_hand_count> hands;  // indexed by HandSide
    double push_back_m = 0.0;              // how far contacts moved the player in this frame
    ArmPose arms;                          // each arm's hand_ws equals Hand::shown_ws exactly
    SpinePose spine;
};

}  // namespace handhold

#pragma once

#include <array>

#include "components/arm.hpp"
#include "components/grab.hpp"
#include "components/hand_rig.hpp"
#include "components/spine.hpp"
#include "engine/math/math.hpp"

// What a host draws. Written by publish_pose; the body by publish_body.
namespace handhold {

struct RenderPose {
    struct Hand {
        Pose tracked_ws;                  // where the controller says the hand is
        Pose shown_ws;                    // where it is drawn: on its anchor while it grips
        Vec3 ray_from_ws = Vec3::Zero();  // the palm's ray
        Vec3 ray_to_ws = Vec3::Zero();
        GripKind grip = GripKind::none;
        std::array<FingerAngles, k_finger_count> fingers;  // by place in HandRig::fingers
    };
    Pose head_ws;
    Vec3 head_center_ws = Vec3::Zero();    // of the collider
    std::array<Hand, k_hand_count> hands;  // by HandSide
    double push_back_m = 0.0;              // how far this frame's contacts moved the player
    ArmPose arms;                          // hands as shown_ws, bit for bit
    SpinePose spine;
};

}  // namespace handhold

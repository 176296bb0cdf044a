#pragma once

#include "components/arm.hpp"
#include "engine/math/math.hpp"

namespace handhold {

// Inputs of pose_arm that are the same for both arms of a player.
struct ArmFrames {
    Pose origin_ws;  // PlayerOrigin
    Pose chest_ws;
    const BodyMeasures& measures;
};

// Poses an arm's joints in the world by two-bone IK from the estimated shoulder to the palm.
void pose_arm(const ArmFrames& frames, const ArmEstimate::Arm& estimate, const Pose& palm_ws,
              ArmPose::Arm& out);

}  // namespace handhold

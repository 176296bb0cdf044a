#pragma once

#include "components/arm.hpp"
#include "components/grab.hpp"
#include "components/hand.hpp"
#include "components/player.hpp"
#include "engine/ecs/column.hpp"

namespace handhold {

struct PoseArmsIo {
    const Column<PlayerOrigin>& origin;    // in
    const Column<BodyMeasures>& measures;  // in: has every player
    const Column<HandOwner>& owner;        // in
    const Column<PalmPose>& palm;          // in
    const Column<ArmEstimate>& estimate;   // in
    Column<ArmPose>& arms;                 // out: has every player
};

// Poses the arms' joints in the world by two-bone IK from the estimated shoulder to the palm. The
// hand's joint equals the palm's pose exactly; if the arm is too short, both bones stretch
// (ArmEstimate::Arm::stretch).
void pose_arms(const PoseArmsIo& io);

}  // namespace handhold

#pragma once

#include "components/player.hpp"
#include "components/spine.hpp"
#include "engine/ecs/column.hpp"
#include "systems/body/shared/limit_joint.hpp"

namespace handhold {

// Limits of a shown foot's motion relative to the chest. A straight leg that its hip pulls along
// (k_pelvis_limits) exceeds them by as much as the hip moves across the foot's way.
inline constexpr JointLimits k_foot_limits = {
    .speed_mps = 2.5, .step_mps = 0.8, .acceleration_mps2 = 80.0, .catch_up_mps2 = 30.0};

struct LimitFeetIo {
    double dt_s;                         // in: > 0
    const Column<PlayerOrigin>& origin;  // in
    Column<SpineMemory>& memory;         // in/out: feet, hips
    Column<SpinePose>& pose;             // in/out: legs
};

// Smooths the shown legs, whatever moved them: the chain, a fold above the floor, a surface or a
// clip. A foot within its limits is where the earlier stages put it, exactly. A foot beyond them
// lags and catches up; its leg keeps its bones' lengths and the plane of its knee. In the frame in
// which the chain restarts from rest, feet are where it puts them.
void limit_feet(const LimitFeetIo& io);

}  // namespace handhold

#pragma once

#include "components/player.hpp"
#include "components/spine.hpp"
#include "engine/ecs/column.hpp"
#include "systems/body/shared/limit_joint.hpp"

namespace handhold {

// Limits of the shown pelvis' motion relative to the chest.
inline constexpr JointLimits k_pelvis_limits = {
    .speed_mps = 1.5, .step_mps = 0.3, .acceleration_mps2 = 27.0, .catch_up_mps2 = 30.0};

// Greatest rate at which the line from hip to hip turns in the play space.
inline constexpr double k_hips_radps = 4.0;

struct LimitPelvisIo {
    double dt_s;                         // in: > 0
    const Column<PlayerOrigin>& origin;  // in
    Column<SpineMemory>& memory;         // in/out: pelvis; in: hips_m
    Column<SpinePose>& pose;             // in/out: all bones except the chest
};

// Smooths the shown trunk, whatever moved it: a surface, a fold above the floor, or the chest. A
// pelvis within its limits is where the earlier stages put it, exactly. Beyond them, spine and legs
// turn about the chest as one rigid body, so that the pelvis lags and catches up. Bones keep their
// lengths and joints below the first their angles. The distance between chest and pelvis, which a
// fold shortens by a few centimetres, is not limited. Then the line from hip to hip turns by at
// most k_hips_radps from where limit_feet saw it last: beyond that, pelvis and legs turn about the
// pelvis' origin as one. In the frame in which the chain restarts from rest, the pelvis is where it
// puts it.
void limit_pelvis(const LimitPelvisIo& io);

}  // namespace handhold

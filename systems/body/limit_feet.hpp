#pragma once

#include "components/player.hpp"
#include "components/spine.hpp"
#include "engine/ecs/column.hpp"

namespace handhold {

// Limits of a shown foot's motion relative to the chest, in the player's metres and the axes of the
// play space: its speed, the change of its velocity in a frame, and its acceleration.
inline constexpr double k_foot_mps = 2.9;
inline constexpr double k_foot_step_mps = 0.9;
inline constexpr double k_foot_mps2 = 80.0;

struct LimitFeetIo {
    double dt_s;                         // in: > 0
    const Column<PlayerOrigin>& origin;  // in
    Column<SpineMemory>& memory;         // in/out: feet
    Column<SpinePose>& pose;             // in/out: legs
};

// Smooths the shown legs, whatever moved them: the chain, a fold above the floor, a surface or a
// clip. A foot within its limits is where the earlier stages put it, exactly. A foot beyond them
// lags and catches up; its leg keeps its bones' lengths and the plane of its knee. In the frame in
// which the chain restarts from rest, feet are where it puts them.
void limit_feet(const LimitFeetIo& io);

}  // namespace handhold

#pragma once

#include "systems/frame/frame.hpp"
#include "systems/physics/solve_phases.hpp"

namespace handhold::lab {

// step_frame with another position solver. With solve_positions it is step_frame, bit for bit.
void step_frame_with(PositionSolver solver, World& world, FrameCaches& caches, const Tuning& tuning,
                     const FrameInput& input, StageStats& stats);

}  // namespace handhold::lab

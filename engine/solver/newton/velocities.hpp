// Solver, newton: the velocity solve. One linear solve per island, after the positions.

#pragma once

#include "engine/solver/newton/island_system.hpp"
#include "engine/solver/newton/settings.hpp"

namespace handhold {

// Fallbacks that an island's velocity solve took.
struct VelocityResult {
    // The stick-slip iteration did not converge, or sweeps replaced a failed direct solve.
    bool unconverged = false;
    bool out_of_work = false;     // ended because it had spent IslandView::max_work
    bool without_drives = false;  // written by the caller: the drives took no part in the solve
};
// Solves the same rows as the position solve for the bodies' velocities v:
//   drives     v_a + v_drive - v_b = 0, and the same for spins (RowBlock::drive_velocity_ws_mps,
//              drive_spin_ws_radps)
//   joints     J v = 0
//   contacts   v_n >= -e v_n(before); e: restitution, 0 for slow impacts
//   friction   |impulse| <= limit, opposing the slip
// Writes the bodies' velocities, the blocks' impulses and the impulses of locked joints.
VelocityResult solve_island_velocities(const IslandView& island, const VelocitySettings& settings,
                                       SolveScratch& scratch);

}  // namespace handhold

#pragma once

#include "engine/solver/newton/newton.hpp"

// Gauss-Seidel on positions, the usual method, as a baseline. Both variants below implement
// PositionSolver and run in the same phases on the same rows as the runtime's solver.
namespace handhold::lab {

inline constexpr int k_sweeps = 50;

// Non-linear Gauss-Seidel (Mueller et al. 2007, Macklin et al. 2016): up to 50 sweeps over the
// blocks at the bodies' current poses, outward from the immovable bodies. Limits and contacts only
// push.
NewtonResult solve_plain(const IslandView& island, const NewtonSettings& settings,
                         SolveScratch& scratch);

// Like solve_plain, but in the last of the 50 sweeps the body of a block that is nearer to an
// immovable one counts as infinitely heavy (shock propagation, Guendelman et al. 2003).
NewtonResult solve_sweep(const IslandView& island, const NewtonSettings& settings,
                         SolveScratch& scratch);

// Sets the number of sweeps. Only residual curves need another number than 50.
void set_sweeps(int count);

}  // namespace handhold::lab

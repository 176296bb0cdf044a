#pragma once

#include "engine/solver/newton/newton.hpp"

// The usual way to solve constraints, to measure the runtime's against: Gauss-Seidel on positions.
// Both follow PositionSolver and run in the same phases on the same rows.
namespace handhold::lab {

inline constexpr int k_sweeps = 50;

// Non-linear Gauss-Seidel (Mueller et al. 2007, Macklin et al. 2016): block after block at the
// present poses, in the order outward from what cannot move, 50 times; limits and contacts only
// push.
NewtonResult solve_plain(const IslandView& island, const NewtonSettings& settings,
                         SolveScratch& scratch);

// The same, and in the last pass each body that is nearer to what cannot move counts as infinitely
// heavy (shock propagation, Guendelman et al. 2003).
NewtonResult solve_sweep(const IslandView& island, const NewtonSettings& settings,
                         SolveScratch& scratch);

// Sweeps from now on: 50 unless a curve over the sweeps is taken.
void set_sweeps(int count);

}  // namespace handhold::lab

// Solver, newton: solves a large jump of the drives' targets in several load steps.

#pragma once

#include "engine/solver/newton/newton.hpp"

namespace handhold {

// Runs Newton's method from the bodies' current poses and leaves the bodies where it ended. Returns
// not converged and 0 iterations if TriadSystem does not accept the island.
using SolveLoadStep = NewtonResult (*)(const IslandView& island, const NewtonSettings& settings,
                                       SolveScratch& scratch);

// True if a solve ran out of iterations on a large jump of a drive. Chains with very different
// masses need load steps then; no number of iterations suffices. A taut or overstretched rope also
// runs out of iterations, frame after frame, but there the iterations hardly reduced the drive's
// error, and load steps would not help.
bool needs_load_stepping(const NewtonResult& full_load, const NewtonSettings& settings);

// Reserves memory for load stepping, so that a warm frame does not allocate if it becomes
// necessary.
void reserve_load_stepping(const IslandView& island, SolveScratch& scratch);

// Applies the load in steps from the poses recorded in `scratch.load_stepped`; each step may take
// as many iterations as a solve. `full_load` is the result of the solve that ran out of iterations;
// the bodies are where it left them. If a load step does not converge, that result is restored.
NewtonResult solve_by_load_stepping(const IslandView& island, const NewtonSettings& settings,
                                    const NewtonResult& full_load, SolveScratch& scratch,
                                    SolveLoadStep solve);

}  // namespace handhold

#pragma once

#include "engine/solver/newton/newton.hpp"

namespace handhold {

// Newton's method from the bodies' present poses, which it leaves where they got to. Not converged,
// in no steps, where the island is not what triads serve.
using SolveLoadStep = NewtonResult (*)(const IslandView& island, const NewtonSettings& settings,
                                       SolveScratch& scratch);

// Where hands jump far, on links of very different masses, no number of steps suffices. True where
// a solve ran out of them on such a jump. A rope that is pulled taut, or that a hand stretches,
// runs out of them too, frame by frame: there the steps brought the hand next to nothing, and parts
// of its way are no easier.
bool needs_load_stepping(const NewtonResult& full_load, const NewtonSettings& settings);

// Room for what leading takes: whether an island's hands will ever be led nobody knows, and a warm
// frame allocates nothing.
void reserve_load_stepping(const IslandView& island, SolveScratch& scratch);

// Leads hands part by part of their way, from where `scratch.led` was taken; each part may take as
// many steps as a solve. `at_once` is the solve that ran out of them, the bodies are where it left
// them. What cannot be had in parts either stays so.
NewtonResult solve_by_load_stepping(const IslandView& island, const NewtonSettings& settings,
                                    const NewtonResult& full_load, SolveScratch& scratch,
                                    SolveLoadStep solve);

}  // namespace handhold

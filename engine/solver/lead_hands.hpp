#pragma once

#include "engine/solver/newton.hpp"

namespace handhold {

// Newton's method from the bodies' present poses, which it leaves where they got to. Not converged,
// in no steps, where the island is not what triads serve.
using SolvePart = NewtonResult (*)(const IslandView& island, const NewtonSettings& settings,
                                   SolveScratch& scratch);

// Where hands jump far, on links of very different masses, no number of steps suffices: they are
// led then, part by part of their way, from where `scratch.led` was taken. `at_once` is the solve
// that ran out of steps, the bodies are where it left them. What cannot be had in parts either
// stays so.
NewtonResult lead_hands(const IslandView& island, const NewtonSettings& settings,
                        const NewtonResult& at_once, SolveScratch& scratch, SolvePart solve);

}  // namespace handhold

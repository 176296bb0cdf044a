#pragma once

#include "components/frame_graph.hpp"
#include "components/stats.hpp"
#include "components/tuning.hpp"
#include "engine/solver/newton/newton.hpp"
#include "systems/physics/shared/mass_shares.hpp"

// One phase of the position solve: its rows, regularisation and work budget.
namespace handhold {

// Moves one island's bodies until its constraint rows are met. Same contract as solve_positions,
// which is the runtime's.
using PositionSolver = NewtonResult (*)(const IslandView&, const NewtonSettings&, SolveScratch&);

// Solves the islands in FrameGraph::island_order with the phase's masses (mass_shares.hpp), largest
// first, on all threads: writes poses
// (world), PhaseBody::work, island_results and island_errors. Islands share no body,
// so the result does not depend on how they are distributed over threads.
// Fallbacks counted: active_set_not_converged, solver_budget, hands_load_stepped,
// load_stepping_failed.
void solve_chosen_islands(Phase phase, const SolverTuning& tuning, PositionSolver solver,
                          FrameGraph& frame, StageStats& stats);

}  // namespace handhold

#pragma once

#include "components/frame_graph.hpp"
#include "components/stats.hpp"
#include "components/tuning.hpp"
#include "engine/collision/collision_world.hpp"
#include "systems/physics/shared/phase_solve.hpp"

// Solves the positions of the frame in phases: designer physics, in which players move objects
// freely and are pushed only by what cannot give way.
// Talk rows 4 (inside the step), 7 (forward and backward phase) and 8 (one-frame convergence).
// Each phase is a Newton solve of every island:
//
// - reach: grips and joints without contacts. A player who grips something fixed is moved; a player
//   who holds a light object has infinite mass.
// - forward: contacts too, players with infinite mass. Only islands with a free body.
// - relax: only heaps (Island::is_heap) that forward left overlapping. Held bodies give way.
// - backward: true masses; the loose bodies of a heap are held still. Runs where forward left a
//   violation and the island touches something immovable or another player: the player is pushed.
//   Players and held objects start from their reach poses, so the push equals the violation,
//   whatever the object's mass (decision 5).
// - contradiction: resolves contacts that still overlap, without grips.
//
// After each phase colliders are swept from their last valid pose to the solved pose. New contacts
// are added and the phase repeats, at most contact.max_rounds times. An island that no contact
// violates never reaches the forward phase: the origin of a player who waves a rock is bitwise
// unchanged.
// The work of every island is bounded (WorkBudget), and so is the number of contacts searched.
// Fallbacks counted: active_set_not_converged, hands_load_stepped, load_stepping_failed,
// contact_rounds_exhausted, contacts_contradict, solver_budget.
namespace handhold {

struct SolvePhasesIo {
    CollisionWorld& collision;  // in/out: proxies follow the solved poses, world
    FrameGraph& frame;          // in: rows; in/out: poses (world), contacts, phase
};
void solve_phases(const SolvePhasesIo& io, const Tuning& tuning, StageStats& stats);

// solve_phases with another method in place of solve_positions. Tools that compare methods call it;
// the runtime does not.
void solve_phases_with(PositionSolver solver, const SolvePhasesIo& io, const Tuning& tuning,
                       StageStats& stats);

}  // namespace handhold

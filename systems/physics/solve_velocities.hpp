#pragma once

#include "components/body.hpp"
#include "components/frame_graph.hpp"
#include "components/player.hpp"
#include "components/stats.hpp"
#include "components/tuning.hpp"
#include "engine/ecs/column.hpp"

// Solves the velocities of the frame and limits spins. Talk row 7.
//
// One solve over the frame's rows: hands move at their tracked velocities, and bodies in contact do
// not approach each other. Displacement by depenetration never becomes velocity.
// systems/physics/shared/mass_shares.hpp says who takes which share of the momentum.
//
// A hand has no limit of force. Near the dead centre of a mechanism (a door pulled towards its
// hinge, a head pressed against the hub of a fan) it would give the mechanism any speed. If the
// work of hands makes a jointed body faster than LocomotionTuning::object_speed_max_mps, its island
// is solved without its hands in this frame: its bodies keep the velocities that they had, and
// contacts and joints still hold. Compared is the speed of the body's points, root mean square.
// Fallbacks counted: friction_not_converged, solver_budget, object_speed_clamped.
namespace handhold {

struct SolveVelocitiesIo {
    const Column<ReferenceVelocity>& reference;  // in: world, m/s
    const Column<PlayerOrigin>& origin;          // in: scale
    FrameGraph& frame;                           // in: rows, phase; out: velocities, impulses
    Column<BodyVelocity>& body_velocity;         // out, free bodies: world, m/s and rad/s
    Column<PlayerVelocity>& player_velocity;     // out: world, m/s
};
void solve_velocities(const SolveVelocitiesIo& io, const Tuning& tuning, StageStats& stats);

}  // namespace handhold

#pragma once

#include "components/body.hpp"
#include "components/frame_graph.hpp"
#include "components/player.hpp"
#include "components/stats.hpp"
#include "components/tracking.hpp"
#include "components/tuning.hpp"
#include "engine/ecs/column.hpp"

// Solves the velocities of the frame, limits spins, enters impulses into stats.ledger, and records
// last valid poses. Talk row 7.
//
// One solve over the frame's rows: hands move at their tracked velocities, and bodies in contact do
// not approach each other. Displacement by depenetration never becomes velocity. Fallbacks counted:
// friction_not_converged, solver_budget, object_speed_clamped.
namespace handhold {

struct UpdateVelocitiesIo {
    const Column<HeadTracking>& head;         // in: a head that was never tracked has no valid pose
    FrameGraph& frame;                        // in: rows, phase; out: velocities, impulses
    Column<BodyVelocity>& body_velocity;      // out, free bodies: world, m/s and rad/s
    Column<PlayerVelocity>& player_velocity;  // out: world, m/s
    Column<LastValidPose>& last_valid;        // out: world
};
void update_velocities(const UpdateVelocitiesIo& io, const Tuning& tuning, StageStats& stats);

}  // namespace handhold

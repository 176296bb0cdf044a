#pragma once

#include "components/body.hpp"
#include "components/frame_graph.hpp"
#include "components/grab.hpp"
#include "components/player.hpp"
#include "components/stats.hpp"
#include "components/tuning.hpp"
#include "engine/ecs/column.hpp"

// Ends the grips that are released in this frame, and limits the velocities that hands gave to
// players and bodies. Talk row 7. Runs after solve_velocities or after a host's own solver.
//
// A tracking error must launch neither a player nor a body, now or when the grip breaks. Speeds are
// relative to the reference velocity. Except at a release, a speed is kept that existed before the
// frame, or that a driven or heavy body causes. Fallbacks counted: release_speed_clamped,
// object_speed_clamped.
namespace handhold {

struct LimitVelocitiesIo {
    const Column<HandOwner>& owner;              // in
    const Column<ReferenceVelocity>& reference;  // in: world, m/s
    const Column<PlayerOrigin>& origin;          // in: scale
    const FrameGraph& frame;                     // in: rows, islands, phase
    Column<BodyVelocity>& body_velocity;         // in/out, free bodies: world, m/s and rad/s
    Column<PlayerVelocity>& player_velocity;     // in/out: world, m/s
    Column<Grab>& grab;                          // in/out: released grips are cleared
};
void limit_velocities(const LimitVelocitiesIo& io, const LocomotionTuning& tuning,
                      StageStats& stats);

}  // namespace handhold

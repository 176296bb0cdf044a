#pragma once

#include "components/body.hpp"
#include "components/tuning.hpp"
#include "engine/ecs/column.hpp"

// Moves kinematic bodies to their poses at the end of the frame. Poses of bodies with a Mover,
// PathMover or LegMover are computed in closed form from the time, so that no error accumulates and
// a hand on a ship has no lag. Bodies with a MoveTarget move to the pose that the host asked for,
// with a velocity that does not depend on how often it asks.
// Talk row 6 (moving supports).
// A LegMover whose torso has no PathMover keeps its pose and gets velocity 0.
// Fallbacks counted: none.
namespace handhold {

struct AnimateMoversIo {
    double dt_s;                          // in: > 0, s
    double end_s;                         // in: end of the frame, s on the world's clock
    const Column<Mover>& mover;           // in: world
    const Column<PathMover>& path_mover;  // in: world
    const Column<LegMover>& leg_mover;    // in: relative to the torso's path
    Column<MoveTarget>& target;           // in: bodies that the host moves; out: their last moves
    Column<BodyPose>& body_pose;          // out, kinematic bodies: world, end of the frame
    Column<BodyStart>& body_start;        // out, kinematic bodies: world, start of the frame
    Column<BodyVelocity>& velocity;       // out, kinematic bodies: world, m/s and rad/s at the end
};
void animate_movers(const AnimateMoversIo& io, const TrackingTuning& tuning);

// A move that comes later than this after the one before begins a motion: it counts as having taken
// this long, since nothing says when it began.
inline constexpr double k_longest_move_s = 0.5;

// Velocity of a body that a host moves, at the end of the frame at end_s. Hosts may tell poses less
// often than they step. So a move lasts from the move before to its own time, and the velocity is
//     v = sum(moved_i) / sum(span_i)
// over the newest moves that span `window_s`. If their spans are equal, the host tells poses at a
// fixed rate and the newest move alone counts: it lags least. A move that took more than
// k_span_ratio times as long as a later one belongs to an earlier motion. The body is at rest if no
// move came for as long as the longest of these moves took.
BodyVelocity told_velocity(const MoveTarget& target, double window_s, double end_s);
inline constexpr double k_span_ratio = 4.0;

// Pose and velocity of a mover at time t_s, world.
Pose mover_pose(const Mover& mover, double t_s);
BodyVelocity mover_velocity(const Mover& mover, double t_s);

inline constexpr double k_leg_step_s = 1e-4;

// World velocity of a leg's bone at time t_s, by a central difference of its pose over +-h, h =
// k_leg_step_s. Truncation error: h^2 / 6 of the third derivative, for instance below 1e-5 m/s for
// feet that swing a metre in 0.4 s. Rounding error: about 1e-12 of the distance to the origin,
// divided by h.
BodyVelocity leg_velocity(const PosePath& torso, const LegMover& mover, double t_s);

}  // namespace handhold

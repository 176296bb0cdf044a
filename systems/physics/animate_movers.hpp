#pragma once

#include "components/body.hpp"
#include "engine/ecs/column.hpp"

// Moves kinematic bodies to their poses at the end of the frame: those with a Mover, PathMover or
// LegMover in closed form of time, so that nothing accumulates and a hand on a ship has no lag;
// those with a MoveTarget to the pose that the host asked for.
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
    // In: bodies that the host moves. Their velocity is the displacement over dt_s.
    const Column<MoveTarget>& target;
    Column<BodyPose>& body_pose;     // out, kinematic bodies: world, end of the frame
    Column<BodyStart>& body_start;   // out, kinematic bodies: world, start of the frame
    Column<BodyVelocity>& velocity;  // out, kinematic bodies: world, m/s and rad/s at the end
};
void animate_movers(const AnimateMoversIo& io);

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

#pragma once

#include "components/body.hpp"
#include "engine/ecs/column.hpp"

namespace handhold {

struct AnimateMoversIo {
    double end_s = 0.0;                   // in: the frame's end
    const Column<Mover>& mover;           // in
    const Column<PathMover>& path_mover;  // in
    const Column<LegMover>& leg_mover;    // in
    Column<BodyPose>& body_pose;          // out: at the end of the frame
    Column<BodyStart>& body_start;        // out: at its start
    Column<BodyVelocity>& velocity;       // out: at the end
};

// Stage 3. Kinematic bodies go where their movers are at the end of the frame, before anything is
// solved: a hand on a ship lags by nothing. All in closed form of the time: a frame skipped or
// repeated changes nothing later. A bone without its torso stays where it is and comes to rest.
void animate_movers(const AnimateMoversIo& io);

// A mover's pose at any time.
Pose mover_pose(const Mover& mover, double t_s);
BodyVelocity mover_velocity(const Mover& mover, double t_s);

// A bone's velocity by a symmetric difference of its pose over +-0.1 ms. The error is h^2 / 6 of
// the third derivative, below 1e-5 m/s for feet that swing a metre in 0.4 s, and rounding of 1e-12
// of the distance to the origin, over h.
BodyVelocity leg_velocity(const PosePath& torso, const LegMover& mover, double t_s);

}  // namespace handhold

#pragma once

#include "components/body.hpp"
#include "engine/ecs/column.hpp"

namespace handhold {

struct AnimateMoversIo {
    double end_s = 0.0;              // in: the frame's end
    const Column<Mover>& mover;      // in
    Column<BodyPose>& body_pose;     // out: at the end of the frame
    Column<BodyStart>& body_start;   // out: at its start
    Column<BodyVelocity>& velocity;  // out: at the end
};

// Stage 3. Kinematic bodies go where their movers are at the end of the frame, before anything is
// solved: a hand on a ship lags by nothing.
void animate_movers(const AnimateMoversIo& io);

// A mover's pose at any time.
Pose mover_pose(const Mover& mover, double t_s);
BodyVelocity mover_velocity(const Mover& mover, double t_s);

}  // namespace handhold

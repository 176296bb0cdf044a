#pragma once

#include "components/body.hpp"
#include "components/player.hpp"
#include "engine/ecs/column.hpp"

// Moves free bodies and players along their velocities, without constraints.
// Talk row 1 (float). A spinning body keeps its angular momentum and energy, not its angular
// velocity, so that it tumbles as a real one does.
// Fallbacks counted: none.
namespace handhold {

struct PredictBodiesIo {
    double dt_s;                                // in: s
    Vec3 gravity_mps2;                          // in: world; free bodies gain it before they move
    const Column<GravityScale>& gravity_scale;  // in: bodies without an element: 1
    const Column<RigidBody>& body;              // in: kg m^2
    const Column<PlayerVelocity>& player_velocity;  // in: world, m/s
    Column<BodyPose>& body_pose;                    // in/out, free bodies: world
    Column<BodyStart>& body_start;        // out, free bodies: pose at the frame's start, world
    Column<BodyVelocity>& body_velocity;  // in/out, free bodies: world, m/s and rad/s
    Column<PlayerOrigin>& origin;         // in/out: world, position only
    Column<PlayerStart>& player_start;    // out: pose at the frame's start, world
};
void predict_bodies(const PredictBodiesIo& io);

}  // namespace handhold

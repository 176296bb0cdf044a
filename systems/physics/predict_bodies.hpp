#pragma once

#include "components/body.hpp"
#include "components/player.hpp"
#include "engine/ecs/column.hpp"

namespace handhold {

struct PredictBodiesIo {
    double dt_s = 0.0;                              // in
    const Column<RigidBody>& body;                  // in
    const Column<PlayerVelocity>& player_velocity;  // in
    Column<BodyPose>& body_pose;                    // in/out: free bodies
    Column<BodyStart>& body_start;                  // out: free bodies
    Column<BodyVelocity>& body_velocity;            // in/out: the spin of free bodies
    Column<PlayerOrigin>& origin;                   // in/out
    Column<PlayerStart>& player_start;              // out
};

// Stage 3. Free bodies and players go where their velocities carry them. Rotation keeps the angular
// momentum and the energy, not the spin: a long thing tumbles as it should.
void predict_bodies(const PredictBodiesIo& io);

}  // namespace handhold

#pragma once

#include "components/body.hpp"
#include "components/body_part.hpp"
#include "components/grab.hpp"
#include "components/player.hpp"
#include "components/stats.hpp"
#include "components/tracking.hpp"
#include "components/tuning.hpp"
#include "engine/ecs/column.hpp"

namespace handhold {

struct LocomotePlayersIo {
    double dt_s;                                // in
    Vec3 scene_velocity_mps;                    // in: reference until something is gripped
    const Column<PlayerCommands>& commands;     // in
    const Column<HeadTracking>& head;           // in
    const Column<HandOwner>& owner;             // in
    const Column<HandTracking>& hand;           // in
    const Column<Grab>& grab;                   // in
    const Column<BodyPose>& body_pose;          // in: at the start of the frame
    const Column<BodyVelocity>& body_velocity;  // in
    Column<PlayerOrigin>& origin;          // in/out: turned about the gripping hand, else the head
    Column<PlayerVelocity>& velocity;      // in/out
    Column<ReferenceVelocity>& reference;  // in/out
    Column<BodyHold>& body_hold;           // in/out: kept in place when the held player turns
};

// Moves players by their commands: snap and smooth turns; brake and thrusters while no hand is on a
// surface. Updates the reference velocity, and turns the play space with a support as
// LocomotionTuning::support_follow says. Two hands on one turning body always make the play space
// follow it fully: two fixed points allow no other motion.
void locomote_players(const LocomotePlayersIo& io, const LocomotionTuning& tuning);

}  // namespace handhold

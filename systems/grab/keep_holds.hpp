#pragma once

#include "components/body.hpp"
#include "components/grab.hpp"
#include "components/player.hpp"
#include "components/tracking.hpp"
#include "engine/ecs/column.hpp"

namespace handhold {

struct KeepHoldsIo {
    Vec3 scene_velocity_mps;                    // in: reference of players that hold nothing
    const Column<HandOwner>& owner;             // in
    const Column<HandTracking>& hand;           // in: end of the frame
    const Column<RigidBody>& body;              // in
    const Column<BodyPose>& body_pose;          // in: end of the frame
    const Column<BodyVelocity>& body_velocity;  // in
    const Column<PlayerOrigin>& origin;         // in: end of the frame
    Column<Grab>& grab;                         // in/out: error_m; cleared if the body is gone
    Column<ReferenceVelocity>& reference;       // out
};

// For hosts that decide what each hand holds (hh_hand_hold). Ends holds on bodies that were
// removed, and writes each hand's distance from its anchor. Sets each player's reference velocity
// to that of the gripped surface, or to the scene's.
void keep_holds(const KeepHoldsIo& io);

}  // namespace handhold

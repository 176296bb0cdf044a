#pragma once

#include "components/body.hpp"
#include "components/frame_graph.hpp"
#include "components/player.hpp"
#include "components/tracking.hpp"
#include "components/tuning.hpp"
#include "engine/collision/collision_world.hpp"
#include "engine/ecs/column.hpp"

// Lists all bodies and players by persistent id and gives their colliders to the collision world.
// Runs before update_grabs and find_contacts. Places all players, and bodies whose components
// changed since the last call; for the other bodies it compares bytes. A proxy's motion is from the
// last valid pose to the current pose. For fixed and kinematic bodies, and for a head without a
// valid pose, it is from the pose at the start of the frame. A player's collider is the sphere of
// the head, at the end of the frame. A head that was never tracked has no contacts.
// Fallbacks counted: none.
namespace handhold {

struct PlaceCollidersIo {
    const Column<PersistentId>& persistent_id;  // in
    const Column<Collider>& collider;           // in
    const Column<CollisionFilter>& filter;      // in: bodies without an element: the default
    const Column<RigidBody>& body;              // in
    const Column<BodyPose>& body_pose;          // in: world, current
    const Column<BodyStart>& body_start;        // in: world, start of the frame
    const Column<BodyVelocity>& body_velocity;  // in: world, m/s and rad/s; whether it changed
    const Column<PlayerOrigin>& origin;         // in: world, current
    const Column<PlayerStart>& player_start;    // in: world, start of the frame
    const Column<HeadTracking>& head;           // in: play space, end of the frame
    const Column<LastValidPose>& last_valid;    // in: world
    CollisionWorld& collision;                  // out: proxies, world
    FrameGraph& frame;                          // out: proxies, entities
};
void place_colliders(const PlaceCollidersIo& io, const HeadTuning& tuning);

}  // namespace handhold

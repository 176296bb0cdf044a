#pragma once

#include "components/body.hpp"
#include "components/frame_graph.hpp"
#include "components/player.hpp"
#include "components/tracking.hpp"
#include "components/tuning.hpp"
#include "engine/collision/collision_world.hpp"
#include "engine/ecs/column.hpp"

namespace handhold {

struct PlaceCollidersIo {
    const Column<PersistentId>& persistent_id;  // in
    const Column<Collider>& collider;           // in
    const Column<RigidBody>& body;              // in
    const Column<BodyPose>& body_pose;          // in
    const Column<BodyStart>& body_start;        // in
    const Column<PlayerOrigin>& origin;         // in
    const Column<PlayerStart>& player_start;    // in
    const Column<HeadTracking>& head;           // in
    const Column<LastValidPose>& last_valid;    // in
    CollisionWorld& collision;                  // out
    FrameGraph& frame;                          // out: proxies, entities
};

// Lists all bodies and players by persistent id and brings their colliders to the collision world:
// from the last valid pose to the present one. Players are the spheres of their heads, at the end
// of the frame.
void place_colliders(const PlaceCollidersIo& io, const HeadTuning& tuning);

}  // namespace handhold

#pragma once

#include "components/body.hpp"
#include "components/frame_graph.hpp"
#include "components/grab.hpp"
#include "components/player.hpp"
#include "components/stats.hpp"
#include "components/tracking.hpp"
#include "components/tuning.hpp"
#include "engine/collision/collision_world.hpp"
#include "engine/ecs/column.hpp"

namespace handhold {

struct PullBodiesIo {
    double dt_s = 0.0;                          // in
    const CollisionWorld& collision;            // in: colliders at the start of the frame
    const Column<PersistentId>& persistent_id;  // in
    const Column<HandOwner>& owner;             // in
    const Column<HandTracking>& hand;           // in
    const Column<Grab>& grab;                   // in
    const Column<PlayerBody>& player;           // in
    const Column<PlayerOrigin>& origin;         // in: at the start of the frame, turned
    const Column<RigidBody>& body;              // in
    const Column<BodyPose>& body_pose;          // in: at the start of the frame
    const JointGroups& joint_groups;            // in
    Column<HandPull>& pull;                     // in/out
    Column<BodyVelocity>& body_velocity;        // in/out
    Column<PlayerVelocity>& player_velocity;    // in/out
};

// Stage 2b, the distance grab; where PullTuning::reach_m is 0, which is the default, nothing. A
// hand that closes on nothing looks along its palm for a loose, light body that no joint ties to
// another and no other hand has or pulls. While that is so and the hand stays closed,
// body and player draw each other with at most PullTuning::force_n between the body's centre of
// mass and the player, so that what of its surface is nearest comes to the palm as that moves, as
// two masses on a rope would: what one gets of momentum the other loses, and what is in the way is
// in the way, for this changes velocities before prediction and nothing else. Slower the nearer it
// is, so that it can be stopped. update_grabs takes it once it is at the palm. A hand that opens
// lets it fly on.
void pull_bodies(const PullBodiesIo& io, const Tuning& tuning, StageStats& stats);

}  // namespace handhold

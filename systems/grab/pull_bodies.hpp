#pragma once

#include "components/body.hpp"
#include "components/frame_graph.hpp"
#include "components/grab.hpp"
#include "components/player.hpp"
#include "components/stats.hpp"
#include "components/tracking.hpp"
#include "components/tuning.hpp"
#include "engine/collision/surface_query.hpp"
#include "engine/ecs/column.hpp"
#include "systems/grab/shared/grab_rules.hpp"

namespace handhold {

struct PullBodiesIo {
    double dt_s;                                // in
    SurfaceQuery surfaces;                      // in: at the start of the frame
    const Column<PersistentId>& persistent_id;  // in
    const Column<HandOwner>& owner;             // in
    const Column<HandTracking>& hand;           // in
    const Column<Grab>& grab;                   // in
    const Column<HandSight>& sight;             // in
    const Column<PlayerBody>& player;           // in
    // in: at the start of the frame, after locomote_players turned it
    const Column<PlayerOrigin>& origin;
    const Column<RigidBody>& body;            // in
    const Column<BodyPose>& body_pose;        // in: at the start of the frame
    const JointGroups& joint_groups;          // in
    GrabRules rules;                          // in
    Column<HandPull>& pull;                   // in/out
    Column<BodyVelocity>& body_velocity;      // in/out
    Column<PlayerVelocity>& player_velocity;  // in/out
};

// The distance grab. Off if PullTuning::reach_m is 0, the default. A hand that closes on nothing,
// with its palm in sight (HandSight), searches along its palm ray for a light free body without
// joints that no other hand grips or pulls, and that this hand may grip alone (GrabRules). While
// the hand stays closed, body and player attract each other like two masses on a rope, with at most
// PullTuning::force_n. The player loses the momentum that the body gains. The body's nearest
// surface point approaches the moving palm and slows down on the way, so that it can be stopped.
// Only velocities change, before prediction, so obstacles act as usual. update_grabs grips the body
// when it is at the palm. If the hand opens, the body flies on. The pull also ends, counted as
// pull_lost, if the hand's tracking is lost, if the body may not be pulled any more, or if it is
// far out of reach.
void pull_bodies(const PullBodiesIo& io, const Tuning& of_all, StageStats& stats);

}  // namespace handhold

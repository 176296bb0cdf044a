#pragma once

#include "components/body.hpp"
#include "components/frame_graph.hpp"
#include "components/grab.hpp"
#include "components/joint.hpp"
#include "components/player.hpp"
#include "components/tracking.hpp"
#include "components/tuning.hpp"
#include "engine/ecs/column.hpp"

namespace handhold {

struct BuildConstraintsIo {
    double dt_s = 0.0;                              // in
    const Column<PersistentId>& persistent_id;      // in
    const Column<RigidBody>& body;                  // in
    const Column<BodyPose>& body_pose;              // in: predicted
    const Column<BodyVelocity>& body_velocity;      // in
    const Column<Joint>& joint;                     // in
    const Column<JointState>& joint_state;          // in
    const Column<PlayerBody>& player;               // in
    const Column<PlayerOrigin>& origin;             // in: predicted
    const Column<PlayerVelocity>& player_velocity;  // in
    const Column<HeadTracking>& head;               // in
    const Column<HandOwner>& owner;                 // in
    const Column<Grab>& grab;                       // in: settled
    FrameGraph& frame;  // in: proxies, entities, contacts; out: graph, phase
};

// Stage 5. The frame as the solver sees it: one solver body a body or player, hand rows for what is
// gripped, rows of joints, contact rows, islands.
void build_constraints(const BuildConstraintsIo& io, const Tuning& tuning);

}  // namespace handhold

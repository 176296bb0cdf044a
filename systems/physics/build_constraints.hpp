#pragma once

#include "components/body.hpp"
#include "components/body_part.hpp"
#include "components/frame_graph.hpp"
#include "components/grab.hpp"
#include "components/joint.hpp"
#include "components/player.hpp"
#include "components/tracking.hpp"
#include "components/tuning.hpp"
#include "engine/ecs/column.hpp"

// Builds the solver's model of the frame: one solver body per body and player, constraint rows for
// grips, joints and contacts, and islands.
// Talk rows 4 (inside the step) and 5 (arbitrary chains).
//
// Rows of a grip: surface or player: three (the point). Held object: six (a weld), three if it is
// jointed to something immovable. Two hands on one object: three for the first hand's point, and
// three for the direction between the hands and the rotation about it; if the hands are too close
// for that, six for the first hand.
// Fallbacks counted: none.
namespace handhold {

struct BuildConstraintsIo {
    double dt_s;                                    // in: s
    const Column<PersistentId>& persistent_id;      // in
    const Column<RigidBody>& body;                  // in: kg, kg m^2
    const Column<BodyPose>& body_pose;              // in: world, predicted
    const Column<BodyVelocity>& body_velocity;      // in: world, m/s and rad/s, start of the frame
    const Column<Joint>& joint;                     // in: body frames, rad or m
    const Column<JointState>& joint_state;          // in: rad or m, of the last frame
    const Column<PlayerBody>& player;               // in: kg
    const Column<PlayerOrigin>& origin;             // in: world, predicted
    const Column<PlayerVelocity>& player_velocity;  // in: world, m/s, start of the frame
    const Column<HeadTracking>& head;               // in: play space
    const Column<HandOwner>& owner;                 // in
    const Column<Grab>& grab;           // in: anchors in body frames, targets in play space
    const Column<BodyHold>& body_hold;  // in: play space, of hands on a player's part
    FrameGraph& frame;                  // in: proxies, entities, contacts; out: graph, phase
};
void build_constraints(const BuildConstraintsIo& io, const Tuning& tuning);

}  // namespace handhold

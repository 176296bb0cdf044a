#pragma once

#include "components/authored_grip.hpp"
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

struct UpdateGrabsIo {
    const CollisionWorld& collision;              // in: colliders at the start of the frame
    const Column<PersistentId>& persistent_id;    // in
    const Column<HandOwner>& owner;               // in
    const Column<HandTracking>& hand;             // in: edges
    const Column<PlayerOrigin>& origin;           // in: at the start of the frame
    const Column<HeadTracking>& head;             // in: as the colliders have it
    const Column<RigidBody>& body;                // in
    const Column<BodyPose>& body_pose;            // in: at the start of the frame
    const JointGroups& joint_groups;              // in
    const Column<AuthoredGrips>& authored_grips;  // in
    const Column<HandPull>& pull;                 // in: of the last frame
    Column<Grab>& grab;                           // in/out
    Column<AuthoredHold>& authored_hold;          // in/out: of hands that sit in an authored grip
    Column<HeadIgnores>& head_ignores;            // in/out: held bodies are added
    const Column<GrabRule>* rule = nullptr;       // in: null: any hand grips anything
    const Column<GrabLayers>* layers = nullptr;   // in
    const Column<CollisionFilter>* filter = nullptr;  // in: layers of bodies
    Column<GrabOrder>* order = nullptr;               // in/out: carried out and removed
    double start_s = 0.0;                             // in: of the frame; for orders
};

// Stage 2. Hands that close look for a surface along the palm's ray, from behind the palm through
// it; where that meets nothing, for the nearest surface within reach of the palm: any surface, from
// any angle, and any other player's head. Hands that open, that are stretched too far, or whose
// body is gone let go; of a player's two stretched hands only the worse, of two alike the one that
// grips for the shorter time. Talk rows 2, 3.
// Before any surface comes an authored grip in whose snap zone the hand closes: of several the one
// of the highest priority, of equal ones that which moves the palm least. One that another hand
// sits in, or that something stands before, does not count. Talk row 10.
// Bodies that refuse the hand by their GrabRule or its player's GrabLayers are passed over, as if
// they were not there. One for two hands is gripped when the second of them closes on it.
// Orders of the host come before everything; they ask no rule.
// A closed hand that pulls a body from afar grips it as soon as it would by closing where it is.
void update_grabs(const UpdateGrabsIo& io, const Tuning& tuning, StageStats& stats);

}  // namespace handhold

#pragma once

#include "components/body.hpp"
#include "components/frame_graph.hpp"
#include "components/grab.hpp"
#include "components/joint.hpp"
#include "components/player.hpp"
#include "components/stats.hpp"
#include "components/tracking.hpp"
#include "components/tuning.hpp"
#include "engine/collision/collision_world.hpp"
#include "engine/ecs/column.hpp"

// Finds the contacts of all colliders at the predicted poses.
// The result does not depend on earlier frames or on the collision world's caches. No contacts are
// made between bodies connected by a joint, unless Joint::collides is set, and between a player's
// head and what that player holds, or has released and still touches.
// Fallbacks counted: none.
namespace handhold {

struct FindContactsIo {
    const Column<PersistentId>& persistent_id;  // in
    const Column<RigidBody>& body;              // in
    const Column<Joint>& joint;                 // in
    const Column<HandOwner>& owner;             // in
    const Column<Grab>& grab;                   // in
    CollisionWorld& collision;  // in: proxies at the predicted poses, world; out: ignored pairs
    // in/out: released bodies are removed once they are clear of the head
    Column<HeadIgnores>& head_ignores;
    FrameGraph& frame;  // in: joint_groups; out: contacts (body frames, m), ignored
};
void find_contacts(const FindContactsIo& io, const ContactTuning& tuning);

}  // namespace handhold

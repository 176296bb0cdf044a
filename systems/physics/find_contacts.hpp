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

namespace handhold {

struct FindContactsIo {
    const Column<PersistentId>& persistent_id;  // in
    const Column<RigidBody>& body;              // in
    const Column<Joint>& joint;                 // in
    const Column<HeadTracking>& head;           // in: a head that was never tracked touches nothing
    const Column<HandOwner>& owner;             // in
    const Column<Grab>& grab;                   // in
    CollisionWorld& collision;  // in/out: proxies at the predicted poses; gets the ignored pairs
    Column<HeadIgnores>&
        head_ignores;   // in/out: bodies let go that are apart from the head are dropped
    FrameGraph& frame;  // out: contacts, ignored
};

// Stage 4. Contacts of all colliders at the predicted poses, made afresh; without those between a
// head and what its player's hands hold, or have let go and are not yet clear of.
void find_contacts(const FindContactsIo& io, const ContactTuning& tuning);

}  // namespace handhold

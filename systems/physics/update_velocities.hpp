#pragma once

#include "components/body.hpp"
#include "components/frame_graph.hpp"
#include "components/grab.hpp"
#include "components/player.hpp"
#include "components/stats.hpp"
#include "components/tracking.hpp"
#include "components/tuning.hpp"
#include "engine/ecs/column.hpp"

namespace handhold {

struct UpdateVelocitiesIo {
    const Column<HandOwner>& owner;              // in
    const Column<ReferenceVelocity>& reference;  // in
    const Column<HeadTracking>& head;     // in: a head that was never tracked has no valid place
    FrameGraph& frame;                    // in/out: velocities, impulses
    Column<BodyVelocity>& body_velocity;  // out: free bodies
    Column<PlayerVelocity>& player_velocity;  // out
    Column<Grab>& grab;  // in/out: hands that let go in this frame are free from here on
    Column<LastValidPose>& last_valid;  // out
};

// Stage 9. One solve over the rows of the frame gives all velocities: hands move as they are
// tracked, contacts do not approach; what positions needed to come apart never becomes speed. Then
// clamps of those who let go, the ledger, and last valid poses.
void update_velocities(const UpdateVelocitiesIo& io, const Tuning& tuning, StageStats& stats);

}  // namespace handhold

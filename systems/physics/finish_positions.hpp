#pragma once

#include "components/body.hpp"
#include "components/frame_graph.hpp"
#include "components/grab.hpp"
#include "components/player.hpp"
#include "components/stats.hpp"
#include "components/tuning.hpp"
#include "engine/collision/collision_world.hpp"
#include "engine/ecs/column.hpp"

namespace handhold {

struct FinishPositionsIo {
    CollisionWorld& collision;     // in/out: proxies follow what is put back
    FrameGraph& frame;             // in/out
    Column<BodyPose>& body_pose;   // out: free bodies
    Column<PlayerOrigin>& origin;  // out
    Column<Grab>& grab;            // out: error
};

// Stage 8, after the phases: writes poses and what is left of errors.
//
// Free bodies that no phase could take out of what they are sunk into (contact.penetration_m) go
// back to where they last overlapped nothing, no more than two metres, if that halves their error:
// a hand's jump through clutter carries nothing into a wall. What moved farther than is swept is
// looked at where it is (find_missed_overlaps): overlaps that its contacts do not show count too,
// put it back, and keep the place from becoming one to go back to. What is sunk into something
// fixed or driven rides along with it and starts the velocity solve at its speed. Bodies of one
// island go back together or not at all; counted by island.
void finish_positions(const FinishPositionsIo& io, const ContactTuning& tuning, StageStats& stats);

}  // namespace handhold

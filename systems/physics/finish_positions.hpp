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
// What no phase could take out of a surface it is sunk into (contact.sunk_m) stays where
// it last overlapped nothing, if that is better: a hand's jump through clutter carries nothing into
// a wall, and no head is squeezed into a gap. It rides along with what it is sunk into, and takes
// its speed. An island that is put back is counted.
void finish_positions(const FinishPositionsIo& io, const ContactTuning& tuning, StageStats& stats);

}  // namespace handhold

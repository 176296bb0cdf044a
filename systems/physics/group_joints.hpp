#pragma once

#include "components/body.hpp"
#include "components/frame_graph.hpp"
#include "components/joint.hpp"
#include "components/tuning.hpp"
#include "engine/ecs/column.hpp"

namespace handhold {

struct GroupJointsIo {
    const Column<Joint>& joint;     // in
    const Column<RigidBody>& body;  // in
    FrameGraph& frame;              // out: joint_groups
};

// Before stage 2. Which free bodies hang together by joints, and which of these groups hang on
// something that a hand cannot move: the world, a fixed, kinematic or heavy body.
void group_joints(const GroupJointsIo& io, const PhaseTuning& tuning);

}  // namespace handhold

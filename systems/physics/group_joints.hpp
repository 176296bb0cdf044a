#pragma once

#include "components/body.hpp"
#include "components/frame_graph.hpp"
#include "components/joint.hpp"
#include "components/tuning.hpp"
#include "engine/ecs/column.hpp"

// Groups free bodies that joints connect, and marks the groups that are anchored: connected to
// something a hand cannot move (the world, or a fixed, kinematic or heavy body). A distance joint
// that may be slack anchors nothing.
// Talk row 5 (arbitrary chains). Runs before update_grabs.
// Fallbacks counted: none.
namespace handhold {

struct GroupJointsIo {
    const Column<Joint>& joint;     // in
    const Column<RigidBody>& body;  // in: kind, kg
    FrameGraph& frame;              // out: joint_groups, in the order of `body`
};
void group_joints(const GroupJointsIo& io, const PhaseTuning& tuning);

}  // namespace handhold

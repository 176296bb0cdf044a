#pragma once

#include "components/frame_graph.hpp"
#include "components/joint.hpp"
#include "engine/ecs/column.hpp"

// Writes where every joint is, and closes and opens latches.
// Talk row 5 (arbitrary chains). A latch whose strength was exceeded opens after that frame.
// Fallbacks counted: none.
namespace handhold {

struct UpdateJointsIo {
    double dt_s;                 // in: s, > 0
    const FrameGraph& frame;     // in: solved poses, velocities and impulses
    const Column<Joint>& joint;  // in: rad or m, N or N m
    Column<JointState>& state;   // in/out, joints with a constraint block: rad or m, rad/s or m/s
};
void update_joints(const UpdateJointsIo& io);

}  // namespace handhold

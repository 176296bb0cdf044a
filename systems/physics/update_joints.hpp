#pragma once

#include "components/frame_graph.hpp"
#include "components/joint.hpp"
#include "engine/ecs/column.hpp"

namespace handhold {

struct UpdateJointsIo {
    double dt_s = 0.0;           // in: > 0
    const FrameGraph& frame;     // in: solved
    const Column<Joint>& joint;  // in
    Column<JointState>& state;   // out: of joints that take part
};

// After stage 9. Where every joint's coordinate is, and which latches have caught or opened. A
// latch that gives way does so after the frame whose impulse was too strong.
void update_joints(const UpdateJointsIo& io);

}  // namespace handhold

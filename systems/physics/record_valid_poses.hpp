#pragma once

#include "components/body.hpp"
#include "components/frame_graph.hpp"
#include "components/tracking.hpp"
#include "engine/ecs/column.hpp"

// Records the poses from which the next frame sweeps.
//
// A body that overlaps by more than k_valid_overlap_m keeps its last valid pose; a fixed or
// kinematic obstacle carries that pose along. Fallbacks counted: none.
namespace handhold {

inline constexpr double k_valid_overlap_m = 1e-4;

struct RecordValidPosesIo {
    const Column<HeadTracking>& head;   // in: a head that was never tracked has no valid pose
    FrameGraph& frame;                  // in: poses, contacts, hidden overlaps; out: active bodies
    Column<LastValidPose>& last_valid;  // in/out: world
};
void record_valid_poses(const RecordValidPosesIo& io);

}  // namespace handhold

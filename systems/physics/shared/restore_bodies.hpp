// Physics: bodies that the phases left penetrating.

#pragma once

#include "components/frame_graph.hpp"
#include "components/stats.hpp"
#include "components/tuning.hpp"
#include "engine/collision/collision_world.hpp"

namespace handhold {

// Restores free bodies that penetrate something by restore_depth_m or more to their last valid
// poses, at most 2 m far. Free bodies and players' heads that a restored body overlaps by 1 mm or
// more are restored too, and all are evaluated once more. An island's restores are kept if they at
// least halve the error of each of its restored bodies. Other bodies stay where the phases put
// them; so do heaps that restores of their own bodies do not help. Contacts and hidden overlaps are
// found again, at most three times. Writes frame.hidden_overlaps. Fallbacks counted:
// restored_last_valid_pose (once an island), solver_budget.
void restore_penetrating_bodies(CollisionWorld& collision, FrameGraph& frame,
                                const ContactTuning& tuning, StageStats& stats);

}  // namespace handhold

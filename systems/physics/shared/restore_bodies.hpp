// Physics: bodies that the phases left penetrating.

#pragma once

#include "components/frame_graph.hpp"
#include "components/stats.hpp"
#include "components/tuning.hpp"
#include "engine/collision/collision_world.hpp"

namespace handhold {

// Restores free bodies that penetrate something by more than restore_depth_m to their last valid
// poses, and what they would overlap there with them: bodies, and players by their heads. What
// stays worse than half of its error is left where the phases put it. Contacts are found again at
// the restored poses. Writes frame.hidden_overlaps. Fallbacks counted: restored_last_valid_pose,
// solver_budget.
void restore_penetrating_bodies(CollisionWorld& collision, FrameGraph& frame,
                                const ContactTuning& tuning, StageStats& stats);

}  // namespace handhold

// Physics: bodies that the phases left penetrating.

#pragma once

#include "components/frame_graph.hpp"
#include "components/stats.hpp"
#include "components/tuning.hpp"
#include "engine/collision/collision_world.hpp"

namespace handhold {

// Restores free bodies that penetrate something by restore_depth_m or more to their last valid
// poses; in an island where that does not at least halve the error of each of these bodies, because
// another body is there now, by half of the way, a quarter and so on. If no share of the way does,
// all stay where the phases put them. Then also restores the bodies and players' heads that they
// would overlap. Contacts are found again at the restored poses. Writes frame.hidden_overlaps.
// Fallbacks counted: restored_last_valid_pose (once an island), solver_budget.
void restore_penetrating_bodies(CollisionWorld& collision, FrameGraph& frame,
                                const ContactTuning& tuning, StageStats& stats);

}  // namespace handhold

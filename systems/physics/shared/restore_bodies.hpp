// Physics: bodies that the phases left penetrating.

#pragma once

#include "components/frame_graph.hpp"
#include "components/stats.hpp"
#include "components/tuning.hpp"
#include "engine/collision/collision_world.hpp"

namespace handhold {

// About the longest jump of a hand. A body that was dragged farther while penetrating is not
// restored.
inline constexpr double k_max_restore_distance_m = 2.0;
// Smaller overlaps with a restored body are left to the next frames: restoring a player as well
// costs the exactness of their hands.
inline constexpr double k_joining_depth_m = 1e-3;

// Restores free bodies that penetrate something by restore_depth_m or more to their last valid
// poses, less than k_max_restore_distance_m far. Free bodies and players' heads that a restored
// body overlaps by k_joining_depth_m or more, outside of heaps, are restored too, and all are
// evaluated once more. An island's restores are kept if they at least halve the error of each of
// its restored bodies. Other bodies stay where the phases put them; so do heaps that restores of
// their own bodies do not help. Contacts and hidden overlaps are found again, at most three times.
// Writes frame.hidden_overlaps. Fallbacks counted: restored_last_valid_pose (once an island),
// solver_budget.
void restore_penetrating_bodies(CollisionWorld& collision, FrameGraph& frame,
                                const ContactTuning& tuning, StageStats& stats);

}  // namespace handhold

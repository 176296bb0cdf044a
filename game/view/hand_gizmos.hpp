#pragma once

#include <vector>

#include "components/tuning.hpp"
#include "game/view/gizmos.hpp"
#include "systems/frame/frame.hpp"

namespace handhold {

// Appends debug lines of the hand stages for the last frame, and the zones of all authored grips.
// Repeats each gripping hand's search to get the order in which triangles were visited. Changes
// nothing else.
void add_hand_gizmos(const World& world, const FrameCaches& caches, const Tuning& tuning,
                     const GizmoSet& on, std::vector<Line>& out);

}  // namespace handhold

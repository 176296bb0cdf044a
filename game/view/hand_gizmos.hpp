#pragma once

#include <vector>

#include "components/tuning.hpp"
#include "game/view/gizmos.hpp"
#include "systems/frame/frame.hpp"

namespace handhold {

// Appends debug lines of the hand stages for every gripping hand, for the last frame. Repeats the
// search to get the order in which triangles were visited; changes nothing.
void add_hand_gizmos(const World& world, const FrameCaches& caches, const Tuning& tuning,
                     const GizmoSet& on, std::vector<Line>& out);

}  // namespace handhold

#pragma once

#include <vector>

#include "components/tuning.hpp"
#include "game/view/gizmos.hpp"
#include "systems/frame.hpp"

namespace handhold {

// What the stages of the hands did with every hand that grips, as lines in the world: after a
// frame, of that frame. The search is done once more for its order; nothing is changed by it.
void add_hand_gizmos(const World& world, const FrameCaches& caches, const Tuning& tuning,
                     const GizmoSet& on, std::vector<Line>& out);

}  // namespace handhold

#pragma once

#include <array>

#include "components/render.hpp"

namespace handhold {

// Where a player of a match is drawn (hh_match_drawn_player), world.
struct DrawnPlace {
    Pose head_ws;
    std::array<Pose, k_hand_count> wrists_ws;  // shown wrists, indexed by HandSide
};

// Moves and turns head and hands to this place. Body and shoulders move with the head, unturned;
// the arms are stretched between.
RenderPose drawn_at(const RenderPose& pose, const DrawnPlace& place);

}  // namespace handhold

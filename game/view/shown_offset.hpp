#pragma once

#include <array>

#include "components/render.hpp"

namespace handhold {

// Displacements with which a player of a match is drawn (hh_match_shown_offsets), m.
struct ShownOffset {
    Vec3 head = Vec3::Zero();  // displacement of the body too
    std::array<Vec3, k_hand_count> hands = {Vec3::Zero(), Vec3::Zero()};  // indexed by HandSide
};

// Moves head and body by one displacement and the hands by theirs; the arms are stretched between.
RenderPose displaced(const RenderPose& pose, const ShownOffset& by);

}  // namespace handhold

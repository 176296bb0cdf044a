#pragma once

#include "systems/frame/frame.hpp"

namespace handhold {

// Throws PreconditionError for everything that a stage would throw for: a frame runs completely or
// not at all. Cost: linear in the number of colliders.
void check_frame(const World& world, const FrameCaches& caches, const Tuning& tuning,
                 const FrameInput& input);

}  // namespace handhold

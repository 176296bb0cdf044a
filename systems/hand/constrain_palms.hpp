#pragma once

#include <span>

#include "components/hand.hpp"
#include "components/hand_surroundings.hpp"
#include "components/tuning.hpp"
#include "engine/ecs/column.hpp"

namespace handhold {

struct ConstrainPalmsIo {
    double dt_s = 0.0;                        // in: length of the frame; infinity: no rate limit
    std::span<const HandSurroundings> hands;  // in: body frame (_bs)
    const Column<GripSurface>& surface;       // in: body frame (_bs)
    Column<PalmOffset>& offset;               // in/out: hand space, metres and radians
    Column<PalmPose>& palm;                   // out: shown wrist, world space
};

// Holds each gripping palm within its limits over the surface. Talk rows 16 and 18.
//
// The limits are PalmTuning::min_height_m, max_height_m and max_angle_rad, and no penetration of
// the palm's capsules. The target is the smallest wrist correction that meets them
// (shared/palm_fit.hpp), solved again whenever the hand moves, so that a hand can roll over an edge
// while it grips. The target jumps at edges; the shown offset follows it at PalmTuning::rate_mps.
// Only the shown hand moves, never the player.
//
// The target of a hand in an authored grip is the authored wrist, at the same rate. Talk row 10.
//
// Idempotent: the target of a hand tracked at its own target stays within 0.1 mm, except a lifted
// hand, whose lift is added to the tracked pose.
//
// Fallbacks counted: none. search_grip counts hands without a surface, which are shown as tracked.
void constrain_palms(const ConstrainPalmsIo& io, const Tuning& tuning);

}  // namespace handhold

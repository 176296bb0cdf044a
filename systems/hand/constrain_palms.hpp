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

// Keeps each gripping palm within its height and tilt limits over the gripped surface. Talk rows 16
// and 18.
//
// The limits are PalmTuning::min_height_m, max_height_m and max_angle_rad; also, the palm's
// capsules must not penetrate. The target is the smallest wrist correction that meets these limits
// (shared/palm_fit.hpp). It is solved again whenever the hand moves, so that a gripping hand can
// roll over an edge. The target jumps at edges; the shown offset follows the target at
// PalmTuning::rate_mps. Only the shown hand moves, never the player.
//
// The target of a hand in an authored grip is the authored wrist pose. Talk row 10.
//
// Idempotent: if a hand is tracked exactly at its target, the target moves by at most 0.1 mm.
// Exception: a lift is always added to the tracked pose.
//
// Counts no fallbacks. A hand without a surface is shown as tracked; search_grip counts it.
void constrain_palms(const ConstrainPalmsIo& io, const Tuning& tuning);

}  // namespace handhold

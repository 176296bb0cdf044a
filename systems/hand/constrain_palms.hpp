#pragma once

#include <span>

#include "components/hand.hpp"
#include "components/hand_surroundings.hpp"
#include "engine/ecs/column.hpp"

namespace handhold {

struct ConstrainPalmsIo {
    std::span<const HandSurroundings> hands;  // in: body frame (_bs)
    const Column<GripSurface>& surface;       // in: body frame (_bs)
    Column<PalmOffset>& offset;               // out: held_*, hand space, metres and radians
};

// Holds each gripping palm within its limits over the surface. Talk rows 16 and 18.
//
// The limits are PalmTuning::min_height_m, max_height_m and max_angle_rad, and no penetration of
// the palm's capsules. PalmOffset::held_* is the smallest wrist correction that meets them, which
// search_grip found for the surface (shared/palm_fit.hpp). It stays where it is on the body until
// the next search. Fingers close from there, and fit_hands starts from there.
//
// A palm in an authored grip is held at the authored wrist. Talk row 10.
//
// Idempotent with an error below 0.1 mm: so far the held pose of a hand that is tracked at its own
// held pose moves.
//
// Fallbacks counted: none. search_grip counts hands without a surface, which are shown as tracked.
void constrain_palms(const ConstrainPalmsIo& io);

}  // namespace handhold

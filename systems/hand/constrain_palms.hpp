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

// Holds each gripping palm at the wrist that search_grip fitted to the surface. Talk rows 16
// and 18.
//
// PalmOffset::held_* is the correction from the present tracked wrist to
// GripSurface::fitted_wrist_bs. At the last search, that was the smallest correction with which the
// palm met PalmTuning::min_height_m, max_height_m and max_angle_rad without penetration
// (shared/palm_fit.hpp). The wrist stays there on the body until the next search, so the tracked
// wrist may since have travelled by up to k_search_again_m (hand_travel_m). Fingers close from the
// held wrist, and fit_hands starts from it.
//
// A palm in an authored grip is held at the authored wrist. Talk row 10. Without a surface, held_*
// is zero.
//
// Idempotent: a hand that is tracked at its own held pose is held there, with an error below 0.1
// mm.
//
// Fallbacks counted: none. search_grip counts hands without a surface.
void constrain_palms(const ConstrainPalmsIo& io);

}  // namespace handhold

#pragma once

#include <span>

#include "components/hand.hpp"
#include "components/hand_surroundings.hpp"
#include "components/tuning.hpp"
#include "engine/ecs/column.hpp"

namespace handhold {

struct ConstrainPalmsIo {
    double dt_s = 0.0;                        // of the frame; infinity: shown is target at once
    std::span<const HandSurroundings> hands;  // in
    const Column<GripSurface>& surface;       // in
    Column<PalmOffset>& offset;               // in/out
    Column<PalmPose>& palm;                   // out
};

// Holds each gripping palm over its surface: not lower than one height, not higher than another,
// not tilted by more than an angle, nothing of the palm sunk. The target is the least move that
// does so, found anew in every frame, so that a hand may roll and twist over an edge while it
// grips; what is shown follows it at PalmTuning::rate_mps, since the target jumps where the surface
// has an edge. Only the hand that is shown moves, never the player. Talk rows 16 and 18.
// A hand in an authored grip is held to that instead, at the same rate. Talk row 10.
// Idempotent: the target of a hand that stands on its target is that place, within 0.1 mm
// (unless the hand is lifted: the lift comes on top of where it is tracked).
void constrain_palms(const ConstrainPalmsIo& io, const Tuning& tuning);

}  // namespace handhold

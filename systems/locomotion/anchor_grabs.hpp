#pragma once

#include "components/stats.hpp"
#include "components/tuning.hpp"
#include "systems/locomotion/shared/grab_instant.hpp"

namespace handhold {

using AnchorGrabsIo = GrabFrame;  // systems/locomotion/shared/grab_instant.hpp

// Stage 3, after prediction. Buttons go down and up between frames; poses of that instant are
// interpolated, so that a path does not depend on the frame rate:
//  - a new grab's anchor is the tracked hand, in the body's frame, at the instant of the edge: no
//    residual, no jump. A body that hands have already is where they lead it, along its joint where
//    it hangs on one (joint_rail.hpp), not where its velocity would take it;
//  - a hand that lets go carries on with its release velocity to the frame's end, and is free then;
//  - where one of a player's two hands on fixed bodies, or on one body, lets go, it leaves at once
//    and the other's anchor is taken again where that hand is: no throw, no jump. The same where a
//    gripping hand's tracking comes back;
//  - two hands on one free body lead it together as long as they are apart: the first's point, the
//    line between them, the twist about it (engine/solver/model/drive_pair.hpp);
//  - a free body in an authored grip of one hand moves into it: its anchor goes to
//    where the grip has the hand, at PalmTuning::rate_mps. That moves the body, never the player.
// Also sets what the hand's constraint aims at in this frame. Each step is taken for all hands
// before the next one: whose hand is listed first never shows.
void anchor_grabs(const AnchorGrabsIo& io, const Tuning& tuning, StageStats& stats);

}  // namespace handhold

#pragma once

#include "components/stats.hpp"
#include "components/tuning.hpp"
#include "systems/grab/shared/grab_instant.hpp"

namespace handhold {

using AnchorGrabsIo = GrabFrame;  // systems/grab/shared/grab_instant.hpp

// Runs after prediction. Takes and moves anchors, and sets the target of each hand's constraint.
// Buttons go down and up between frames. Poses at that instant are interpolated, so the path does
// not depend on the frame rate.
//  - New grab: the anchor is the tracked hand in the body's frame at the instant of the edge, so
//    nothing jumps. A body that other hands already hold is where they move it, along its joint if
//    it has one (joint_rail.hpp), not where its velocity would take it.
//  - Release: the hand continues at its release velocity to the end of the frame; off a body that
//    another player still holds, it moves as the body does.
//  - If one of a player's two hands on fixed bodies, or on one body, lets go, it leaves at once and
//    the other hand takes a new anchor where it is: no throw, no jump.
//  - If a gripping hand is `resumed`, it takes a new anchor where it is. Its displacement is kept
//    in Grab::slip_hs, and a free body returns by it at HandTuning::return_speed_mps.
//  - A hand faster than TrackingTuning::max_hand_speed_mps slips by the rest.
//  - Two hands on one free body drive it together while they are apart: the first hand's point, the
//    line between the hands, the twist about it (engine/solver/model/drive_pair.hpp).
//  - A free body held by one hand in an authored grip moves into the hand at PalmTuning::rate_mps.
// Every step is done for all hands before the next step, so the order of hands has no effect.
void anchor_grabs(const AnchorGrabsIo& io, const Tuning& tuning, StageStats& stats);

}  // namespace handhold

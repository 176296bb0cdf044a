#pragma once

#include "components/authored_grip.hpp"
#include "components/body.hpp"
#include "components/grab.hpp"
#include "components/joint.hpp"
#include "components/player.hpp"
#include "components/stats.hpp"
#include "components/tracking.hpp"
#include "components/tuning.hpp"
#include "engine/ecs/column.hpp"

namespace handhold {

struct SettleGrabsIo {
    double start_s = 0.0;  // in: the frame
    double end_s = 0.0;
    const Column<HandOwner>& owner;             // in
    const Column<HandTracking>& hand;           // in
    const Column<HandHistory>& hand_history;    // in: the hands' ways within the frame
    const Column<PlayerStart>& player_start;    // in
    const Column<PlayerOrigin>& origin;         // in: predicted
    const Column<HeadTracking>& head;           // in
    const Column<BodyStart>& body_start;        // in
    const Column<BodyPose>& body_pose;          // in: predicted
    const Column<AuthoredHold>& authored_hold;  // in
    const Column<RigidBody>& body;              // in
    const Column<Joint>& joint;                 // in
    const Column<JointState>& joint_state;      // in: at the frame's start
    Column<Grab>& grab;                         // in/out: anchor, target, phase, two_handed
};

// Stage 3, after prediction. Buttons go down and up between frames; poses of that instant are
// interpolated, so that a path does not depend on the frame rate:
//  - a new grab's anchor is the tracked hand, in the body's frame, at the instant of the edge: no
//    residual, no jump. A body that hands have already is where they lead it, along its joint where
//    it hangs on one (joint_rail.hpp), not where its velocity would take it;
//  - a hand that lets go carries on with its release velocity to the frame's end, and is free then;
//  - where one of a player's two hands on fixed things, or on one body, lets go, it leaves at once
//    and the other's anchor is taken anew where that hand is: no throw, no jump. The same where a
//    gripping hand's tracking comes back;
//  - two hands on one free body lead it together as long as they are apart: the first's point, the
//    line between them, the twist about it (engine/solver/two_hands.hpp);
//  - a free body that one hand has by an authored grip comes into the hand: its anchor goes to
//  where
//    the grip has the hand, at PalmTuning::rate_mps. That moves the body, never the player.
// Also sets what the hand's constraint aims at in this frame.
void settle_grabs(const SettleGrabsIo& io, const Tuning& tuning, StageStats& stats);

}  // namespace handhold

#pragma once

#include <span>

#include "components/grab.hpp"
#include "components/stats.hpp"
#include "components/tracking.hpp"
#include "components/tuning.hpp"
#include "engine/ecs/column.hpp"

namespace handhold {

struct ReadTrackingIo {
    std::span<const PlayerInput>
        inputs;                  // in: at most one a player; players without one keep their poses
    double frame_start_s = 0.0;  // in
    double frame_end_s = 0.0;    // in: > frame_start_s
    const Column<HandOwner>& owner;                      // in
    const Column<ControllerToHand>& controller_to_hand;  // in: hands without one use Tuning's
    Column<HeadTracking>& head;                          // in/out
    Column<HandTracking>& hand;                          // in/out
    Column<HandHistory>& history;                        // in/out
    Column<PlayerCommands>& commands;                    // out
};

// Stage 1. Brings samples of any rate to the frame clock: poses at the end of the frame,
// interpolated where a later sample is known, held otherwise; button edges at their own sample's
// time. Samples that are out of order or not finite are ignored and counted; a device silent for
// longer than lost_after_s is lost and its pose frozen. Where a head jumps farther than max_jump_m
// from one sample to the next, all of the player's readings are shifted back by as much from there
// on; a hand farther than max_arm_m from its head is not believed in that sample; a hand that jumps
// comes back as from lost tracking. Each is counted. Commands hold for their own frame only;
// numbers in them that are not finite ask for nothing.
void read_tracking(const ReadTrackingIo& io, const Tuning& tuning, StageStats& stats);

// The hand in a controller that has no joint of its own; mirrored in x for the left.
Pose default_controller_to_hand(HandSide side, const HandTuning& tuning);

}  // namespace handhold

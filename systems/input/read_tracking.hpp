#pragma once

#include <span>

#include "components/grab.hpp"
#include "components/player.hpp"
#include "components/stats.hpp"
#include "components/tracking.hpp"
#include "components/tuning.hpp"
#include "engine/ecs/column.hpp"

namespace handhold {

struct ReadTrackingIo {
    std::span<const PlayerInput> inputs;  // in: at most one per player; without one, poses are held
    double frame_start_s;                 // in
    double frame_end_s;                   // in: > frame_start_s
    const Column<PlayerOrigin>& origin;   // in: scale
    const Column<HandOwner>& owner;       // in
    // in: hands without it use default_controller_to_hand
    const Column<ControllerToHand>& controller_to_hand;
    const Column<RecenterGuess>& recenter_guess;  // in: without it, jumps are corrected
    const Column<Grab>& grab;                     // in: the last frame's grips
    Column<HeadTracking>& head;                   // in/out
    Column<HandTracking>& hand;                   // in/out
    Column<HandHistory>& history;                 // in/out
    Column<PlayerCommands>& commands;             // out
};

// Resamples devices of any rate to the frame clock. Poses at the end of the frame are interpolated
// if a later sample is known, and held otherwise. Button edges keep the time and pose of their
// sample.
//
// Ignored, and counted: samples out of order; poses that are not finite; a controller at exactly
// (0, 0, 0); a hand farther than max_arm_m from its head; a hand that would have moved faster than
// max_hand_speed_mps. A jump of a hand is used once two consecutive samples agree and the hand
// could have travelled that far since the last sample used. A hand that reappears elsewhere after
// ignored or missing samples, or that returns after it was lost, is `resumed`: it counts as not
// having travelled, and takes new anchors. A device silent for longer than lost_after_s is lost and
// its pose frozen.
//
// If the head jumps by more than max_jump_m, or head and hands jump by one turn about +Y and one
// translation (recentring), later samples are corrected by HeadTracking's shift so that the head
// stays where it was. For players whose RecenterGuess::guesses is false, such jumps are intended:
// head and hands follow them, and gripping hands take new anchors.
//
// Inferred samples, whose poses the runtime guesses: an inferred hand is in TrackingState::inferred
// and does not grip. It follows the guesses. But while a hand of its player grips something that
// the player can pull on (can_push_off), the position of the player's inferred head and the pose of
// each inferred hand that grips something stay where they were. No jump to or from a guess counts
// as a recentring. The next measured sample of an inferred hand makes it `resumed`.
//
// Commands hold for their own frame. Numbers in them that are not finite count as 0.
void read_tracking(const ReadTrackingIo& io, const Tuning& tuning, StageStats& stats);
// read_tracking for the players at the indices [first, last) of `head`. Ranges that share no player
// may be read in parallel.
void read_tracking(const ReadTrackingIo& io, std::size_t first, std::size_t last,
                   const Tuning& tuning, StageStats& stats);

// Pose, in the controller's frame, of a hand without a ControllerToHand component. Mirrored in x
// for the left hand.
Pose default_controller_to_hand(HandSide side, const HandTuning& tuning);

}  // namespace handhold

#pragma once

#include <span>

#include "components/stats.hpp"
#include "components/tracking.hpp"
#include "components/tuning.hpp"
#include "systems/input/shared/play_space_tracker.hpp"

namespace handhold {

struct HandReaderIo {
    double frame_start_s;  // in
    double frame_end_s;    // in: > frame_start_s
    HandSide side;         // in
    double scale;          // in: PlayerOrigin::scale
    bool freezes_guesses;  // in: guesses of the runtime do not move the hand
    HandTracking& hand;    // in/out
    HandHistory& history;  // in/out
};

// Reads one hand's samples of a frame: which of them count, the button, and the pose at the frame's
// end. `tuning` has the numbers of a player of that scale. Counts what it ignores: see
// read_tracking.
void read_hand(const HandReaderIo& io, std::span<const FollowedSample> samples,
               const Tuning& tuning, StageStats& stats);

}  // namespace handhold

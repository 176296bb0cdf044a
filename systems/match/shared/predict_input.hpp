#pragma once

#include <array>

#include "systems/match/shared/input_history.hpp"

namespace handhold {

// After so many ticks without a real input a player counts as away: hands open and devices are not
// tracked, so the hands let go and the body floats.
inline constexpr MatchTick k_away_after_ticks = 90;

// Lag of guesses: no device travels farther than so many ticks of its line.
inline constexpr double k_lag_ticks = 40.0;

// Where a device goes, from its last real poses.
struct DeviceTrend {
    Pose last;
    Vec3 step_m = Vec3::Zero();    // a tick
    Vec3 turn_rad = Vec3::Zero();  // a tick
};
// All that guesses about a player's next ticks are made of.
struct InputTrend {
    MatchTick newest = 0;                               // the last real tick; 0: the player is away
    MatchInput input;                                   // input of that tick
    std::array<DeviceTrend, 1 + k_hand_count> devices;  // the head, the hands
};

// Finds the trend of the last final inputs. Every machine computes the same bits from the same
// final inputs: the server fills missing inputs with guesses, and says only that it did.
//
// Devices continue along a line through the last nine real poses (least squares, the newest with
// the largest weights). Poses before a
// jump do not count, and speeds are bounded.
InputTrend trend_of(const InputHistory& history);

// Guesses the input of a tick after the trend's newest. A device travels ever slower: k ticks ahead
// as far as k / (1 + k / k_lag_ticks) ticks of its line. Buttons, sticks and curls are held; there
// are no edges and no snap turns.
MatchInput predict_input(const InputTrend& trend, MatchTick tick);

}  // namespace handhold

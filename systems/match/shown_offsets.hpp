#pragma once

#include <array>

#include "components/world.hpp"
#include "systems/match/match_world.hpp"

namespace handhold {

// Points that a player is recognised by, in the world.
struct PlayerPoints {
    Vec3 head = Vec3::Zero();
    // Indexed by HandSide: the tracked hand, or where a gripping hand holds.
    std::array<Vec3, k_hand_count> hands = {Vec3::Zero(), Vec3::Zero()};
};
using PointsOfAll = std::array<PlayerPoints, k_most_match_players>;  // indexed by slot

// Of the players that are in the world; the others' are zero.
void note_points(const MatchWorld& match, PointsOfAll& out);

// What a client adds to drawn positions, so that a correction of wrong guesses moves them within
// k_shown_correction_s instead of at once. An offset begins as the position before the correction
// minus that after it. It decays critically damped, so that drawn velocities change over a few
// ticks, and no faster than k_most_mps.
// Offsets are only drawn; they are never part of the world.
//
// All hands that hold one loose body have the offset of the first of them, in the order of
// World::grab, from the next correction on: add it to the body too.
//
// A player's own head moves by a correction when somebody else pulls at what they hold: that offset
// is for the own view too, with all that it shows of the player.
class ShownOffsets {
  public:
    // After this and at most one tick more, nineteen twentieths of a correction are shown, s.
    static constexpr double k_shown_correction_s = 0.08;
    // Largest speed of an offset; larger corrections take longer.
    static constexpr double k_most_mps = 1.35;
    // A larger correction is no wrong guess but a teleport, and is shown at once.
    static constexpr double k_most_m = 0.5;

    // Call before and after the world went back and was stepped again to the same tick.
    void begin_correction(const MatchWorld& match) { note_points(match, before_); }
    void end_correction(const MatchWorld& match);
    // Call once a tick.
    void advance(double dt_s);
    void forget() { offsets_ = rates_ = {}; }

    // Displacements, m; indexed by slot.
    const PointsOfAll& offsets() const { return offsets_; }

  private:
    void share_held_offsets(const MatchWorld& match);

    PointsOfAll before_;
    PointsOfAll after_;
    PointsOfAll offsets_;
    PointsOfAll rates_;  // velocities of the offsets, m/s
};

}  // namespace handhold

#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "systems/match/match_world.hpp"
#include "systems/match/shared/input_history.hpp"
#include "systems/match/shown_offsets.hpp"

namespace handhold {

// Where a player is drawn, world.
struct DrawnPlayer {
    struct Hand {
        Pose shown_ws;          // wrist to draw
        Pose shown_in_tracked;  // the same, seen from the tracked wrist
        bool is_holding = false;
    };
    Pose origin_ws;  // play space
    Pose head_ws;
    std::array<Hand, k_hand_count> hands;  // indexed by HandSide
};

// Poses to draw at a time between two ticks: from the last shown tick but one to the last, with
// ShownOffsets. Nothing of it is part of the world.
class DrawnPoses {
  public:
    // Play spaces and bodies that move farther, and play spaces that turn more, between two shown
    // ticks jump, as by a teleport or a snap turn: they are drawn after the jump. So is what a
    // player holds whose play space jumps.
    static constexpr double k_most_m = 0.5;
    static constexpr double k_most_rad = 0.2;

    // Call after each tick that is shown, and again for the same tick if there was no other.
    void note(const MatchWorld& match, const PointsOfAll& offsets);
    // The world is replaced.
    void forget() { notes_ = 0; }
    bool is_empty() const { return notes_ == 0; }

    // Poses at `before_ticks` before the last shown tick; those of the shown tick before that, at
    // the earliest. Precondition: not empty.
    DrawnPlayer player(std::size_t slot, double before_ticks) const;
    // `now_ws`: for a body that was not there in both ticks.
    Pose body(const World& world, Entity body, const Pose& now_ws, double before_ticks) const;

  private:
    struct Tick {
        MatchTick tick = 0;
        std::array<DrawnPlayer, k_most_match_players> players;
        // Owners of World::body_pose, whose order a match does not change.
        std::vector<Entity> owners;
        std::vector<Pose> bodies_ws;
    };
    static bool is_there(const Tick& tick, std::size_t index, Entity body) {
        return index < tick.owners.size() && tick.owners[index] == body;
    }
    // Share of the way from the tick before to the last one.
    double share_at(double before_ticks) const;
    const Tick& last() const { return ticks_[(notes_ - 1) % 2]; }
    const Tick& before() const { return ticks_[notes_ > 1 ? notes_ % 2 : 0]; }

    std::array<Tick, 2> ticks_;
    std::vector<std::size_t> moved_;  // scratch
    std::size_t notes_ = 0;
};

}  // namespace handhold

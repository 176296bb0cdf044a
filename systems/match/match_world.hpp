#pragma once

#include <array>
#include <cstddef>

#include "systems/frame/frame.hpp"
#include "systems/match/shared/match_input.hpp"

namespace handhold {

// The world of a match on one machine. All of it must outlive the session that has it.
struct MatchWorld {
    World& world;
    FrameCaches& caches;
    const Tuning& tuning;
    double dt_s = 1.0 / 90.0;  // length of a tick
    // The match's players; the index is the player's slot. All are in the world, also while nobody
    // plays them.
    std::array<PersistentId, k_most_match_players> players{};
    std::size_t player_count = 0;
};

// The inputs of all slots in one tick, and those used in the tick before.
struct TickInputs {
    std::array<const MatchInput*, k_most_match_players> before{};
    std::array<const MatchInput*, k_most_match_players> now{};
};

// Steps the world by one tick, with step_frame or step_simulated. Players that are not in the world
// are left out.
void step_tick(const MatchWorld& match, const TickInputs& inputs, bool is_shown, StageStats& stats);

}  // namespace handhold

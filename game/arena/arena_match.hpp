#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include <handhold/match.hpp>

#include "game/arena/arena_game.hpp"

namespace handhold {

// The arena's rules as the host's own state of a match: saved, restored, stepped and hashed with
// the world. Must live as long as the match.
class ArenaMatch {
  public:
    // `world` and `game` must outlive it. `game.state` follows the state of the match's present
    // tick.
    ArenaMatch(hh::World& world, ArenaGame& game)
        : game_(game),
          match_(
              [&world, &game](ArenaState& state, std::uint64_t tick,
                              std::span<const std::uint32_t>) {
                  ArenaGame::step(game.plan, world, tick, state);
                  game.state = state;
              },
              game.state) {}

    hh_match_game callbacks() { return match_.callbacks(); }
    const ArenaState& state() const { return match_.state; }
    void set(const ArenaState& state) {
        match_.state = state;
        game_.state = state;
    }

  private:
    ArenaGame& game_;
    hh::MatchGame<ArenaState> match_;
};

}  // namespace handhold

#pragma once

#include <cstddef>
#include <memory>
#include <optional>
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

// A match's state as it is sent and recorded: that of the library, then that of the rules.
struct JoinedState {
    std::span<const std::byte> of_match;
    ArenaState of_rules;  // the default, if the scene has no rules
};
// nullopt: the end is no state of rules.
inline std::optional<JoinedState> split_join_state(std::span<const std::byte> bytes,
                                                   bool has_rules) {
    if (!has_rules) {
        return JoinedState{bytes, {}};
    }
    if (bytes.size() < k_arena_state_bytes) {
        return std::nullopt;
    }
    const std::optional<ArenaState> rules = read_arena_state(bytes.last(k_arena_state_bytes));
    return rules
               ? std::optional(JoinedState{bytes.first(bytes.size() - k_arena_state_bytes), *rules})
               : std::nullopt;
}

}  // namespace handhold

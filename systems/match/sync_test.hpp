#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "systems/match/match_world.hpp"
#include "systems/match/shared/input_history.hpp"
#include "systems/snapshot/simulated_state.hpp"

namespace handhold {

// The first tick whose hash differed when it was stepped again.
struct SyncDifference {
    MatchTick tick = 0;  // 0: none
    bool in_world = false;
    bool in_host = false;
};

// Finds what rollback would break, on one machine and without a network: after each tick it goes
// back and steps the last ticks again with the same inputs. State that is not restored, or a step
// that depends on anything but state and inputs, gives another hash.
class SyncTest {
  public:
    // `depth`: ticks that each advance steps again, [1, k_match_window - 2].
    SyncTest(const MatchWorld& match, std::size_t depth);

    // One input for each slot. Only the last of the steps is shown.
    SyncDifference advance(std::span<const MatchInput> inputs, bool is_shown = true);

    MatchTick now() const { return match_.world.clock.frame; }
    std::uint64_t ticks() const { return now() - start_; }
    std::uint64_t steps_again() const { return steps_again_; }
    // The match's hash after the last tick.
    std::uint64_t hash() const;

  private:
    struct Kept {
        SimulatedState world;
        std::uint64_t world_hash = 0;
        std::uint64_t host_hash = 0;
        std::array<MatchInput, k_most_match_players> inputs;  // inputs of the tick
    };
    void step(bool is_shown);
    void keep(Kept& kept);
    Kept& at(MatchTick tick) { return kept_[tick % k_match_window]; }

    MatchWorld match_;
    std::size_t depth_;
    MatchTick start_;
    bool is_start_kept_ = false;
    std::array<Kept, k_match_window> kept_;
    std::uint64_t steps_again_ = 0;
    StageStats stats_;
    TickScratch scratch_;
};

}  // namespace handhold

#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "systems/match/confirmed_inputs.hpp"
#include "systems/match/join_state.hpp"
#include "systems/match/match_world.hpp"

namespace handhold {

struct SpectatorCounts {
    std::uint64_t ticks = 0;        // ticks that the world advanced
    std::uint64_t hashes = 0;       // compared hashes
    std::uint64_t out_of_sync = 0;  // compared hashes that differed
    RefusalCounts refused{};
};

// A machine without a player: it steps confirmed ticks only, so it guesses nothing and never goes
// back. Also what plays a recorded match again. No sockets and no clock. No allocation once warm,
// except in join. 2 MB: allocate it on the heap.
class SpectatorSession {
  public:
    // Ticks that the world is behind the inputs that have come, so that packets may be late.
    static constexpr double k_behind_ticks = 9.0;

    // As of ClientSession.
    explicit SpectatorSession(const MatchWorld& match);
    [[nodiscard]] std::optional<FileError> join(std::span<const std::byte> state,
                                                const SnapshotAssets& assets,
                                                const MissingHeads& heads = {});

    // Takes a packet of write_confirmed. Refused packets change nothing, and are counted.
    MatchRefusal receive(std::span<const std::byte> packet);
    // How many times to call advance for so much time of the local clock.
    int ticks_due(double elapsed_s);
    // See TickPacer::past_ticks.
    double past_ticks() const { return std::min(debt_ticks_, 1.0); }
    // Steps the next confirmed tick. False: its inputs have not come.
    bool advance(bool is_shown = true);

    const MatchWorld& match() const { return match_; }
    MatchTick now() const { return match_.world.clock.frame; }
    // The inputs up to this tick have come.
    MatchTick received() const { return histories_[0].final_until(); }
    // As of ServerSession, for recordings.
    std::size_t write_watched(MatchTick after, MatchTick& until, std::span<std::byte> bytes) const;
    bool can_write_after(MatchTick after) const;

    // The match's hash (match_hash) after the present tick.
    std::uint64_t hash() const;
    // True if a hash of the server's differs from this world's, or inputs came that are too far
    // ahead: the host must fetch a state and call join.
    bool needs_state() const { return needs_state_; }
    const SpectatorCounts& counts() const { return counts_; }

  private:
    std::span<InputHistory> histories() { return std::span(histories_).first(match_.player_count); }
    std::span<const InputHistory> histories() const {
        return std::span(histories_).first(match_.player_count);
    }

    MatchWorld match_;
    std::array<InputHistory, k_most_match_players> histories_;
    HashMarks hashes_;
    double debt_ticks_ = 0.0;
    bool needs_state_ = false;
    SpectatorCounts counts_;
    StageStats stats_;
    TickScratch scratch_;
};

}  // namespace handhold

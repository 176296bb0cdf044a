#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "systems/match/shared/input_history.hpp"

namespace handhold {

// Decides with which tick a stream's part of the next packet begins. Each input is sent in
// k_repeats packets, whatever the round trip is; every k_heal_every-th packet begins where the
// receiver's acknowledgement ends, which heals longer losses. While the receiver is far behind,
// each packet begins where the last one ended, so that a round trip brings more than one packet's
// inputs; every k_restart_every-th begins at the acknowledgement, where a lost one left a gap.
class SendMarks {
  public:
    static constexpr std::size_t k_repeats = 4;
    static constexpr std::uint64_t k_heal_every = 8;
    static constexpr std::uint64_t k_restart_every = 32;

    void reset(MatchTick tick) {
        marks_.fill(tick);
        written_until_ = tick;
    }
    // The part begins after this tick. `acknowledged`: the receiver has everything up to this tick.
    // `until`: the newest input. `packet`: number of the packet.
    MatchTick base(std::uint64_t packet, MatchTick acknowledged, MatchTick until) const {
        constexpr MatchTick k_far = 64;
        const bool is_far = until > acknowledged + k_far;
        if (packet % (is_far ? k_restart_every : k_heal_every) == 0) {
            return acknowledged;
        }
        return std::clamp(is_far ? written_until_ : marks_[packet % k_repeats], acknowledged,
                          until);
    }
    // `written_until`: the last tick in the packet.
    void note(std::uint64_t packet, MatchTick written_until) {
        marks_[packet % k_repeats] = written_until;
        written_until_ = written_until;
    }

  private:
    std::array<MatchTick, k_repeats> marks_{};
    MatchTick written_until_ = 0;  // the end of the last packet
};

}  // namespace handhold

#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "systems/match/shared/input_history.hpp"

namespace handhold {

// Decides with which tick a stream's part of the next packet begins. Each input is sent in
// k_repeats packets, whatever the round trip is; every k_heal_every-th packet begins where the
// receiver's acknowledgement ends, which heals longer losses.
class SendMarks {
  public:
    static constexpr std::size_t k_repeats = 4;
    static constexpr std::uint64_t k_heal_every = 8;

    void reset(MatchTick tick) { marks_.fill(tick); }
    // The part begins after this tick. `acknowledged`: the receiver has everything up to this tick.
    // `until`: the newest input. `packet`: number of the packet.
    MatchTick base(std::uint64_t packet, MatchTick acknowledged, MatchTick until) const {
        constexpr MatchTick k_far = 64;  // longer than any round trip: the receiver lacks inputs
        const bool heals = packet % k_heal_every == 0 || until > acknowledged + k_far;
        return heals ? acknowledged : std::clamp(marks_[packet % k_repeats], acknowledged, until);
    }
    // `written_until`: the last tick in the packet.
    void note(std::uint64_t packet, MatchTick written_until) {
        marks_[packet % k_repeats] = written_until;
    }

  private:
    std::array<MatchTick, k_repeats> marks_{};
};

}  // namespace handhold

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
// inputs; if the acknowledgement stands still, what was sent after it was lost, and they begin
// again there.
class SendMarks {
  public:
    static constexpr std::size_t k_repeats = 4;
    static constexpr std::uint64_t k_heal_every = 8;

    void reset(MatchTick tick) {
        marks_.fill(tick);
        written_until_ = acknowledged_ = tick;
        still_ = 0;
    }
    // The part begins after this tick. `acknowledged`: the receiver has everything up to this tick.
    // `until`: the newest input. `packet`: number of the packet.
    MatchTick base(std::uint64_t packet, MatchTick acknowledged, MatchTick until) {
        constexpr MatchTick k_far = 64;
        constexpr int k_most_still = 24;  // packets; about a quarter of a second
        still_ = acknowledged == acknowledged_ ? still_ + 1 : 0;
        acknowledged_ = acknowledged;
        if (until > acknowledged + k_far) {
            if (still_ > k_most_still) {
                still_ = 0;
                written_until_ = acknowledged;
            }
            return std::clamp(written_until_, acknowledged, until);
        }
        return packet % k_heal_every == 0
                   ? acknowledged
                   : std::clamp(marks_[packet % k_repeats], acknowledged, until);
    }
    // `written_until`: the last tick in the packet.
    void note(std::uint64_t packet, MatchTick written_until) {
        marks_[packet % k_repeats] = written_until;
        written_until_ = written_until;
    }

  private:
    std::array<MatchTick, k_repeats> marks_{};
    MatchTick written_until_ = 0;  // the end of the last packet
    MatchTick acknowledged_ = 0;
    int still_ = 0;  // packets since the acknowledgement changed
};

}  // namespace handhold

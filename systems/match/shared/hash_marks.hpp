#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "systems/match/shared/input_history.hpp"

namespace handhold {

// Every so many ticks the hashes of all machines are compared.
inline constexpr MatchTick k_hash_every_ticks = 90;

// Hashes of the last confirmed ticks that all machines compare.
class HashMarks {
  public:
    // Precondition: `tick` is a multiple of k_hash_every_ticks, and not 0.
    void set(MatchTick tick, std::uint64_t hash) { place(tick) = {tick, hash}; }
    // nullopt: not known, or forgotten.
    std::optional<std::uint64_t> at(MatchTick tick) const {
        const Mark& mark = marks_[tick / k_hash_every_ticks % marks_.size()];
        return tick != 0 && mark.tick == tick ? std::optional(mark.hash) : std::nullopt;
    }
    void forget() { marks_ = {}; }

  private:
    struct Mark {
        MatchTick tick = 0;
        std::uint64_t hash = 0;
    };
    Mark& place(MatchTick tick) { return marks_[tick / k_hash_every_ticks % marks_.size()]; }

    std::array<Mark, 8> marks_{};
};

}  // namespace handhold

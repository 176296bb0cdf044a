#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "systems/match/shared/input_codec.hpp"
#include "systems/match/shared/match_input.hpp"

namespace handhold {

using MatchTick = std::uint64_t;  // FrameClock::frame after the tick's step

// How an input came to be used in its tick.
enum class InputKind : std::uint8_t {
    none,       // nothing is known of the tick
    own,        // the player's own, which the server has not confirmed
    predicted,  // a guess, until the tick is final
    real,       // final: what the player sent
    filled,     // final: the prediction that the server took in its place
};
inline bool is_final(InputKind kind) {
    return kind == InputKind::real || kind == InputKind::filled;
}

inline const MatchInput k_away_input{};

// One player's inputs of the last k_capacity ticks. All ticks up to final_until() are final, in
// order; before the first tick the player is away.
class InputHistory {
  public:
    static constexpr std::size_t k_capacity = 512;

    // Forgets everything; ticks up to `tick` are final, and the player was away.
    void reset(MatchTick tick) {
        for (Entry& entry : entries_) {
            entry = {};
        }
        final_until_ = tick;
        last_real_ = 0;
    }
    // The input used in the tick; that of a player who is away if nothing is known of it.
    const MatchInput& at(MatchTick tick) const {
        const Entry& entry = entries_[tick % k_capacity];
        return entry.kind != InputKind::none && entry.tick == tick ? entry.input : k_away_input;
    }
    InputKind kind_at(MatchTick tick) const {
        const Entry& entry = entries_[tick % k_capacity];
        return entry.tick == tick ? entry.kind : InputKind::none;
    }
    // The last three inputs before `tick` that their player sent, of the last k_looks_back ticks:
    // what the tick's input is encoded against. Inputs that the server filled are not among them,
    // so that whoever decodes need not compute them first.
    static constexpr MatchTick k_looks_back = 64;
    InputsBefore before(MatchTick tick) const {
        InputsBefore found = {&k_away_input, &k_away_input, &k_away_input};
        std::size_t count = 0;
        for (MatchTick back = 1; back <= k_looks_back && back < tick && count < 3; ++back) {
            const InputKind kind = kind_at(tick - back);
            if (kind == InputKind::real || kind == InputKind::own) {
                found[count++] = &at(tick - back);
            }
        }
        return found;
    }

    // Sets what is used in a tick that is not final.
    void set(MatchTick tick, const MatchInput& input, InputKind kind) {
        entries_[tick % k_capacity] = {input, tick, kind};
    }
    // The next tick after final_until() becomes final.
    void finish_next(const MatchInput& input, InputKind kind) {
        ++final_until_;
        set(final_until_, input, kind);
        if (kind == InputKind::real) {
            last_real_ = final_until_;
        }
    }

    // Ticks after `tick`, which is final, are final no more: nothing is known of them.
    void forget_after(MatchTick tick) {
        for (Entry& entry : entries_) {
            if (entry.tick > tick) {
                entry = {};
            }
        }
        final_until_ = tick;
        last_real_ = 0;
        for (const Entry& entry : entries_) {
            last_real_ =
                entry.kind == InputKind::real ? std::max(last_real_, entry.tick) : last_real_;
        }
    }

    MatchTick final_until() const { return final_until_; }
    // The last final tick whose input the player sent; 0: none.
    MatchTick last_real() const { return last_real_; }

  private:
    struct Entry {
        MatchInput input;
        MatchTick tick = 0;
        InputKind kind = InputKind::none;
    };
    std::array<Entry, k_capacity> entries_;
    MatchTick final_until_ = 0;
    MatchTick last_real_ = 0;
};

}  // namespace handhold

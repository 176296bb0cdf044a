#include "systems/match/confirmed_inputs.hpp"

#include <algorithm>
#include <array>
#include <optional>

#include "engine/core/check.hpp"
#include "systems/match/packet_frame.hpp"
#include "systems/match/shared/predict_input.hpp"

namespace handhold {
namespace {

constexpr unsigned k_players_bits = 4;
constexpr unsigned k_after_bits = 32;
constexpr MatchTick k_farthest = k_oldest_confirmed - 1;

// The last three inputs that each player sent, the newest first. Copies: they outlive the packet's
// own inputs.
class SentBefore {
  public:
    SentBefore(std::span<const InputHistory> histories, MatchTick after) {
        for (std::size_t slot = 0; slot < histories.size(); ++slot) {
            const InputsBefore found = histories[slot].before(after + 1);
            for (std::size_t i = 0; i < found.size(); ++i) {
                inputs_[slot][i] = *found[i];
            }
        }
    }
    InputsBefore of(std::size_t slot) const {
        const auto& kept = inputs_[slot];
        const std::size_t newest = newest_[slot];
        return {&kept[newest], &kept[(newest + 1) % 3], &kept[(newest + 2) % 3]};
    }
    void add(std::size_t slot, const MatchInput& input) {
        newest_[slot] = (newest_[slot] + 2) % 3;
        inputs_[slot][newest_[slot]] = input;
    }

  private:
    std::array<std::array<MatchInput, 3>, k_most_match_players> inputs_;
    std::array<std::size_t, k_most_match_players> newest_{};
};

// Calls take(tick, slot, input) for each input, null for one that the server filled, and
// take_hash(tick, hash). Returns the last tick.
template <typename Take, typename TakeHash>
MatchTick read_ticks(BitReader& in, std::span<const InputHistory> histories, MatchTick after,
                     const Take& take, const TakeHash& take_hash) {
    SentBefore before(histories, after);
    MatchTick tick = after;
    while (in.take_flag() && !in.has_failed()) {
        ++tick;
        for (std::size_t slot = 0; slot < histories.size(); ++slot) {
            if (in.take_flag()) {
                take(tick, slot, nullptr);
                continue;
            }
            const MatchInput input = read_input(before.of(slot), in);
            before.add(slot, input);
            take(tick, slot, &input);
        }
        if (tick % k_hash_every_ticks == 0 && in.take_flag()) {
            take_hash(tick, in.take(64));
        }
    }
    return tick;
}

}  // namespace

bool can_write_confirmed(std::span<const InputHistory> histories, MatchTick after,
                         MatchTick confirmed) {
    return after <= confirmed && std::ranges::all_of(histories, [&](const InputHistory& history) {
               return after + k_oldest_confirmed >= history.final_until() &&
                      confirmed <= history.final_until();
           });
}

std::size_t write_confirmed(std::span<const InputHistory> histories, const HashMarks& hashes,
                            MatchTick after, MatchTick& until, std::span<std::byte> bytes) {
    HH_CHECK(bytes.size() >= k_most_confirmed_bytes, "a packet of confirmed inputs is 8 kB long",
             bytes.size());
    const std::size_t room = bytes.size() - k_checksum_bytes;
    BitWriter out(bytes.first(room));
    begin_packet(PacketKind::confirmed, out);
    out.put(histories.size() - 1, k_players_bits);
    out.put(after, k_after_bits);
    SentBefore before(histories, after);
    const MatchTick last = std::min(until, after + k_most_confirmed_ticks);
    until = after;
    for (MatchTick tick = after + 1; tick <= last; ++tick) {
        const std::size_t begin = out.bits();
        out.put_flag(true);
        for (std::size_t slot = 0; slot < histories.size(); ++slot) {
            const bool is_filled = histories[slot].kind_at(tick) != InputKind::real;
            out.put_flag(is_filled);
            if (!is_filled) {
                write_input(before.of(slot), histories[slot].at(tick), out);
                before.add(slot, histories[slot].at(tick));
            }
        }
        if (tick % k_hash_every_ticks == 0) {
            const std::optional<std::uint64_t> hash = hashes.at(tick);
            out.put_flag(hash.has_value());
            out.put(hash.value_or(0), hash ? 64 : 0);
        }
        if (out.has_failed() || out.bits() + 1 > 8 * room) {
            out.rewind(begin);
            break;
        }
        until = tick;
    }
    out.put_flag(false);
    return end_packet(out, bytes);
}

MatchRefusal read_confirmed(std::span<const std::byte> bytes, MatchTick now,
                            std::span<InputHistory> histories, HashMarks& hashes) {
    constexpr std::size_t k_most_bytes = std::size_t{1} << 20U;
    std::span<const std::byte> payload;
    if (const MatchRefusal refusal =
            open_packet(bytes, PacketKind::confirmed, k_most_bytes, payload);
        refusal != MatchRefusal::none) {
        return refusal;
    }
    BitReader in = read_frame(payload);
    if (in.take(k_players_bits) + 1 != histories.size()) {
        return MatchRefusal::sender;
    }
    const MatchTick after = in.take(k_after_bits);
    const MatchTick known = histories.front().final_until();
    if (in.has_failed()) {
        return MatchRefusal::malformed;
    }
    if (after > known || after + k_oldest_confirmed < known) {
        return MatchRefusal::gap;
    }
    // All of it is read before anything changes.
    BitReader first = in;
    const MatchTick until = read_ticks(
        first, histories, after, [](MatchTick, std::size_t, const MatchInput*) {},
        [](MatchTick, std::uint64_t) {});
    if (!is_at_end(first) || until > after + k_most_confirmed_ticks) {
        return MatchRefusal::malformed;
    }
    if (until > now + k_farthest) {
        return MatchRefusal::window;
    }
    (void)read_ticks(
        in, histories, after,
        [&](MatchTick tick, std::size_t slot, const MatchInput* input) {
            InputHistory& history = histories[slot];
            if (tick <= known) {
                return;  // known already
            }
            if (input != nullptr) {
                history.finish_next(*input, InputKind::real);
            } else {
                history.finish_next(predict_input(trend_of(history), tick), InputKind::filled);
            }
        },
        [&](MatchTick tick, std::uint64_t hash) {
            if (tick > known) {
                hashes.set(tick, hash);
            }
        });
    return MatchRefusal::none;
}

}  // namespace handhold

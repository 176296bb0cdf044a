#include "systems/match/join_state.hpp"

#include <algorithm>
#include <optional>
#include <string>

#include "systems/match/match_messages.hpp"

namespace handhold {
namespace {

// So many ticks of inputs: as far back as guesses and the encoding of later inputs look.
constexpr MatchTick k_inputs_kept = k_away_after_ticks + 32;
constexpr std::size_t k_epoch_at = 16;
constexpr std::size_t k_header_bytes = 20;     // magic, size of the inputs, slots, checksum, epoch
constexpr std::uint32_t k_magic = 0x314a4848;  // "HHJ1"

FileError join_refusal(const char* place, std::string expected) {
    return {"join state", place, "expected " + std::move(expected)};
}

void put_u32(std::uint32_t value, std::span<std::byte> bytes, std::size_t at) {
    for (std::size_t i = 0; i < 4; ++i) {
        bytes[at + i] = static_cast<std::byte>((value >> (8 * i)) & 0xffU);
    }
}
std::uint32_t get_u32(std::span<const std::byte> bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        value |= std::to_integer<std::uint32_t>(bytes[at + i]) << (8 * i);
    }
    return value;
}

// Final inputs may be this far ahead of the snapshot's tick.
constexpr MatchTick k_most_ahead = InputHistory::k_capacity / 2 - 1;
constexpr unsigned k_ahead_bits = 8;

// The first tick whose input is kept.
MatchTick first_kept(MatchTick tick) { return tick > k_inputs_kept ? tick - k_inputs_kept + 1 : 1; }

// Each slot's inputs from first_kept(tick) to its final_until(). Those after `tick` are final too:
// the server has received them and passed them on.
void write_inputs(std::span<const InputHistory> histories, MatchTick tick, BitWriter& out) {
    for (const InputHistory& history : histories) {
        const MatchTick last = std::min(history.final_until(), tick + k_most_ahead);
        out.put(last - tick, k_ahead_bits);
        InputsBefore before = {&k_away_input, &k_away_input, &k_away_input};
        for (MatchTick at = first_kept(tick); at <= last; ++at) {
            const InputKind kind = history.kind_at(at);
            out.put(static_cast<std::uint64_t>(kind), 3);
            if (kind != InputKind::none) {
                write_input(before, history.at(at), out);
                before = {&history.at(at), before[0], before[1]};
            }
        }
    }
}

bool read_inputs(BitReader& in, MatchTick tick, std::span<InputHistory> histories) {
    for (InputHistory& history : histories) {
        history.reset(first_kept(tick) - 1);
        const MatchTick last = tick + in.take(k_ahead_bits);
        InputsBefore before = {&k_away_input, &k_away_input, &k_away_input};
        for (MatchTick at = first_kept(tick); at <= last; ++at) {
            const auto kind = in.take_as<std::uint8_t>(3);
            const bool is_known = kind != static_cast<std::uint8_t>(InputKind::none);
            if (kind > static_cast<std::uint8_t>(InputKind::filled) ||
                (is_known && !is_final(static_cast<InputKind>(kind)))) {
                return false;
            }
            MatchInput input;
            if (is_known) {
                input = read_input(before, in);
            }
            if (in.has_failed()) {
                return false;
            }
            history.finish_next(input, static_cast<InputKind>(kind));
            if (is_known) {
                before = {&history.at(at), before[0], before[1]};
            }
        }
    }
    return in.bits_left() < 8;
}

}  // namespace

void write_join_state(const MatchWorld& match, const SnapshotAssets& assets,
                      std::span<const InputHistory> histories, std::uint8_t state_epoch,
                      std::vector<std::byte>& bytes) {
    constexpr std::size_t k_most_input_bytes = 64 + 5 * 64;
    std::vector<std::byte> snapshot;
    save_snapshot(match.world, assets, snapshot);
    const std::size_t most =
        histories.size() * (k_inputs_kept + k_most_ahead) * k_most_input_bytes;
    bytes.assign(k_header_bytes + most, std::byte{0});
    BitWriter out{std::span(bytes).subspan(k_header_bytes)};
    write_inputs(histories, match.world.clock.frame, out);
    const std::size_t inputs = out.bytes();
    bytes.resize(k_header_bytes + inputs);
    bytes.insert(bytes.end(), snapshot.begin(), snapshot.end());
    put_u32(k_magic, bytes, 0);
    put_u32(static_cast<std::uint32_t>(inputs), bytes, 4);
    put_u32(static_cast<std::uint32_t>(histories.size()), bytes, 8);
    put_u32(state_epoch, bytes, k_epoch_at);
    put_u32(match_checksum(std::span(bytes).subspan(k_epoch_at, 4 + inputs)), bytes, 12);
}

std::optional<FileError> read_join_state(std::span<const std::byte> bytes,
                                         const SnapshotAssets& assets, const MatchWorld& match,
                                         std::span<InputHistory> histories,
                                         std::uint8_t& state_epoch) {
    if (bytes.size() < k_header_bytes || get_u32(bytes, 0) != k_magic) {
        return join_refusal("byte 0", "the state of a match");
    }
    const std::size_t inputs = get_u32(bytes, 4);
    if (inputs > bytes.size() - k_header_bytes) {
        return join_refusal("byte 4", "no more bytes of inputs than there are");
    }
    if (get_u32(bytes, 8) != histories.size()) {
        return join_refusal("byte 8", std::to_string(histories.size()) + " players");
    }
    const std::uint32_t epoch = get_u32(bytes, k_epoch_at);
    if (match_checksum(bytes.subspan(k_epoch_at, 4 + inputs)) != get_u32(bytes, 12) || epoch > 3) {
        return join_refusal("byte 12", "the checksum of epoch and inputs");
    }
    World restored;
    if (std::optional<FileError> error =
            restore_snapshot(bytes.subspan(k_header_bytes + inputs), assets, restored)) {
        return error;
    }
    std::vector<InputHistory> read(histories.size());
    BitReader in(bytes.subspan(k_header_bytes, inputs));
    if (!read_inputs(in, restored.clock.frame, read)) {
        return join_refusal("byte 20", "the inputs of the last ticks");
    }
    restored.name_of_id = std::move(match.world.name_of_id);
    match.world = std::move(restored);
    std::ranges::copy(read, histories.begin());
    state_epoch = static_cast<std::uint8_t>(epoch);
    return std::nullopt;
}

}  // namespace handhold

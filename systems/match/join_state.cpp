#include "systems/match/join_state.hpp"

#include <algorithm>
#include <optional>
#include <string>

#include "systems/match/match_messages.hpp"
#include "systems/match/shared/predict_input.hpp"

namespace handhold {
namespace {

// So many ticks of inputs: as far back as guesses and the encoding of later inputs look.
constexpr MatchTick k_inputs_kept = k_away_after_ticks + 32;
// The first 16 bytes are magic, size of the inputs, number of slots and a checksum. The checksum
// covers the rest up to the snapshot: epoch, size of the host's part, inputs, the host's part.
constexpr std::size_t k_checked_from = 16;
constexpr std::size_t k_header_bytes = 24;
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
    std::vector<std::byte> of_host;
    if (match.host.write != nullptr) {
        match.host.write(match.host.context, of_host);
    }
    const std::size_t most = histories.size() * (k_inputs_kept + k_most_ahead) * k_most_input_bytes;
    bytes.assign(k_header_bytes + most, std::byte{0});
    BitWriter out{std::span(bytes).subspan(k_header_bytes)};
    write_inputs(histories, match.world.clock.frame, out);
    const std::size_t inputs = out.bytes();
    bytes.resize(k_header_bytes + inputs);
    bytes.insert(bytes.end(), of_host.begin(), of_host.end());
    put_u32(k_magic, bytes, 0);
    put_u32(static_cast<std::uint32_t>(inputs), bytes, 4);
    put_u32(static_cast<std::uint32_t>(histories.size()), bytes, 8);
    put_u32(state_epoch, bytes, k_checked_from);
    put_u32(static_cast<std::uint32_t>(of_host.size()), bytes, k_checked_from + 4);
    put_u32(match_checksum(std::span<const std::byte>(bytes).subspan(k_checked_from)), bytes, 12);
    bytes.insert(bytes.end(), snapshot.begin(), snapshot.end());
}

std::optional<FileError> read_join_state(std::span<const std::byte> bytes,
                                         const SnapshotAssets& assets, const MissingHeads& heads,
                                         const MatchWorld& match, std::span<InputHistory> histories,
                                         std::uint8_t& state_epoch) {
    if (bytes.size() < k_header_bytes || get_u32(bytes, 0) != k_magic) {
        return join_refusal("byte 0", "the state of a match");
    }
    const std::size_t left = bytes.size() - k_header_bytes;
    const std::size_t inputs = get_u32(bytes, 4);
    const std::size_t of_host = get_u32(bytes, k_checked_from + 4);
    if (inputs > left || of_host > left - inputs) {
        return join_refusal("byte 4", "no more bytes of inputs than there are");
    }
    if (get_u32(bytes, 8) != histories.size()) {
        return join_refusal("byte 8", std::to_string(histories.size()) + " players");
    }
    const std::size_t snapshot_at = k_header_bytes + inputs + of_host;
    const std::uint32_t epoch = get_u32(bytes, k_checked_from);
    const std::span<const std::byte> checked = bytes.first(snapshot_at).subspan(k_checked_from);
    if (match_checksum(checked) != get_u32(bytes, 12) || epoch > 3) {
        return join_refusal("byte 12", "the checksum of epoch and inputs");
    }
    World restored;
    if (std::optional<FileError> error =
            restore_snapshot(bytes.subspan(snapshot_at), assets, restored, heads)) {
        return error;
    }
    if (restored.clock.frame > k_last_start_tick) {
        return join_refusal("the snapshot's clock", "a tick below 2^32");
    }
    std::vector<InputHistory> read(histories.size());
    BitReader in(bytes.subspan(k_header_bytes, inputs));
    if (!read_inputs(in, restored.clock.frame, read)) {
        return join_refusal("byte 24", "the inputs of the last ticks");
    }
    const MatchHost& host = match.host;
    if (host.read != nullptr &&
        !host.read(host.context, bytes.subspan(k_header_bytes + inputs, of_host))) {
        return join_refusal("the host's part", "what this host can read");
    }
    restored.name_of_id = std::move(match.world.name_of_id);
    match.world = std::move(restored);
    std::ranges::copy(read, histories.begin());
    state_epoch = static_cast<std::uint8_t>(epoch);
    if (host.joined != nullptr) {
        host.joined(host.context);
    }
    return std::nullopt;
}

}  // namespace handhold

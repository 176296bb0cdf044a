#include "systems/match/match_messages.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/check.hpp"
#include "systems/match/packet_frame.hpp"

namespace handhold {
namespace {

constexpr unsigned k_slot_bits = 4;
constexpr unsigned k_tick_bits = 32;
constexpr unsigned k_epoch_bits = 2;       // ClientPacket::state_epoch
constexpr unsigned k_lead_epoch_bits = 8;  // TickPacer::epoch
constexpr unsigned k_wait_bits = 12;
constexpr double k_waits_per_s = 4096.0;  // +-0.5 s
constexpr unsigned k_length_bits = 14;    // length of a stream in bits
constexpr unsigned k_tick_rice = 4;       // Rice parameter of ticks relative to another one
// Ticks farther back than this are not in the histories any more.
constexpr MatchTick k_oldest = InputHistory::k_capacity - 16;

std::size_t room_for(std::size_t players, std::span<const std::byte> bytes) {
    HH_CHECK(bytes.size() >= 64 * players, "a packet needs 64 bytes a player", bytes.size());
    return std::min(bytes.size(), k_most_packet_bytes) - k_checksum_bytes;
}

std::int32_t behind(MatchTick reference, MatchTick tick) {
    return static_cast<std::int32_t>(static_cast<std::int64_t>(reference) -
                                     static_cast<std::int64_t>(tick));
}
// The tick so far behind the reference; 0 for one before the match.
MatchTick tick_behind(MatchTick reference, std::uint32_t folded) {
    const std::int64_t tick = static_cast<std::int64_t>(reference) - unfold_sign(folded);
    return static_cast<MatchTick>(std::max<std::int64_t>(0, tick));
}

// A flag before each entry says that there is one. Stops where the message has `most_bits`.
void write_stream(StreamSource& source, std::size_t most_bits, BitWriter& out) {
    source.until = std::min(source.until, source.base + StreamPart::k_most);
    InputsBefore before = {&k_away_input, &k_away_input, &k_away_input};
    if (!source.is_fresh) {
        before = source.history->before(source.base + 1);
    }
    for (MatchTick tick = source.base + 1; tick <= source.until; ++tick) {
        const std::size_t before_bits = out.bits();
        const InputHistory& history = *source.history;
        out.put_flag(true);
        const bool is_filled = history.kind_at(tick) == InputKind::filled;
        out.put_flag(is_filled);
        if (!is_filled && !source.is_receivers_own) {
            write_input(before, history.at(tick), out);
        }
        if (out.has_failed() || out.bits() > most_bits) {
            out.rewind(before_bits);
            source.until = tick - 1;
            break;
        }
        if (!is_filled && !source.is_receivers_own) {
            before = {&history.at(tick), before[0], before[1]};
        }
    }
    out.put_flag(false);
}

// Reads the entries of a part whose base is known.
class StreamReader {
  public:
    StreamReader(const InputHistory& history, StreamPart& part)
        : part_(part), before_(history.before(part.base + 1)) {}

    // `may_fill`: the part may have filled entries. `is_own`: its other entries are not sent.
    MatchRefusal read(bool may_fill, bool is_own, BitReader& in) {
        part_.count = 0;
        while (in.take_flag()) {
            if (part_.count == StreamPart::k_most) {
                return MatchRefusal::malformed;
            }
            StreamPart::Entry& entry = part_.entries[part_.count++];
            entry.is_filled = in.take_flag();
            entry.is_sent = !entry.is_filled && !is_own;
            if (entry.is_filled && !may_fill) {
                return MatchRefusal::malformed;
            }
            if (entry.is_sent) {
                entry.input = read_input(before_, in);
                before_ = {&entry.input, before_[0], before_[1]};
            }
            if (in.has_failed()) {
                return MatchRefusal::malformed;
            }
        }
        return in.has_failed() ? MatchRefusal::malformed : MatchRefusal::none;
    }

  private:
    StreamPart& part_;
    InputsBefore before_;
};

}  // namespace

std::size_t write_client_packet(const ClientHeader& header, std::size_t players, StreamSource& own,
                                std::span<std::byte> bytes) {
    const std::size_t room = room_for(players, bytes);
    BitWriter out(bytes.first(room));
    begin_packet(PacketKind::client, out);
    out.put(header.slot, k_slot_bits);
    MatchTick newest = header.known_until[0];
    for (std::size_t slot = 1; slot < players; ++slot) {
        newest = std::max(newest, header.known_until[slot]);
    }
    out.put(header.state_epoch, k_epoch_bits);
    out.put(newest, k_tick_bits);
    for (std::size_t slot = 0; slot < players; ++slot) {
        out.put_rice(fold_sign(behind(newest, header.known_until[slot])), k_tick_rice);
    }
    out.put(header.lead_epoch, k_lead_epoch_bits);
    out.put_flag(header.wants_state);
    out.put_flag(header.is_fresh);
    out.put_flag(header.hash_tick != 0);
    if (header.hash_tick != 0) {
        out.put(header.hash_tick, k_tick_bits);
        out.put(header.hash, 64);
    }
    out.put_rice(fold_sign(behind(newest, own.base)), k_tick_rice);
    write_stream(own, 8 * room - 1, out);
    return end_packet(out, bytes);
}

MatchRefusal read_client_packet(std::span<const std::byte> bytes, std::size_t players,
                                const ClientPacketSource& source, ClientPacket& out) {
    std::span<const std::byte> payload;
    if (const MatchRefusal refusal =
            open_packet(bytes, PacketKind::client, k_most_packet_bytes, payload);
        refusal != MatchRefusal::none) {
        return refusal;
    }
    BitReader in = read_frame(payload);
    out.slot = in.take_as<std::uint8_t>(k_slot_bits);
    if (out.slot >= players || out.slot != source.slot) {
        return MatchRefusal::sender;
    }
    out.state_epoch = in.take_as<std::uint8_t>(k_epoch_bits);
    if (out.state_epoch != source.state_epochs[out.slot]) {
        return MatchRefusal::window;
    }
    const MatchTick newest = in.take(k_tick_bits);
    for (std::size_t slot = 0; slot < players; ++slot) {
        out.known_until[slot] = tick_behind(newest, in.take_rice(k_tick_rice));
        if (!in.has_failed() && out.known_until[slot] > source.histories[slot].final_until()) {
            return MatchRefusal::window;  // nobody can know that
        }
    }
    out.lead_epoch = in.take_as<std::uint8_t>(k_lead_epoch_bits);
    out.wants_state = in.take_flag();
    out.is_fresh = in.take_flag();
    out.hash_tick = 0;
    if (in.take_flag()) {
        out.hash_tick = in.take(k_tick_bits);
        out.hash = in.take(64);
    }
    const InputHistory& history = source.sent[out.slot];
    out.own.base = tick_behind(newest, in.take_rice(k_tick_rice));
    if (in.has_failed()) {
        return MatchRefusal::malformed;
    }
    if (!out.is_fresh && out.own.base > history.final_until()) {
        return MatchRefusal::gap;
    }
    if (out.own.base + k_oldest < history.final_until()) {
        return MatchRefusal::window;
    }
    static const InputHistory k_nothing{};
    const MatchRefusal refusal =
        StreamReader(out.is_fresh ? k_nothing : history, out.own).read(false, false, in);
    return refusal == MatchRefusal::none && !is_at_end(in) ? MatchRefusal::malformed : refusal;
}

std::size_t write_server_packet(const ServerHeader& header, std::size_t players,
                                std::span<StreamSource> streams, std::span<std::byte> bytes) {
    const std::size_t room = room_for(players, bytes);
    BitWriter out(bytes.first(room));
    begin_packet(PacketKind::server, out);
    out.put(header.slot, k_slot_bits);
    out.put(header.state_epoch, k_epoch_bits);
    out.put(header.confirmed_until, k_tick_bits);
    out.put_rice(fold_sign(behind(header.confirmed_until, header.received_until)), k_tick_rice);
    out.put(header.lead_epoch, k_lead_epoch_bits);
    constexpr double k_most = (1U << (k_wait_bits - 1)) - 1;
    const double wait =
        std::clamp(std::floor(header.wait_s * k_waits_per_s + 0.5), -k_most, k_most);
    out.put(static_cast<std::uint64_t>(wait + k_most), k_wait_bits);
    out.put_flag(header.is_out_of_sync);
    for (std::size_t slot = 0; slot < players; ++slot) {
        StreamSource& stream = streams[slot];
        out.put_rice(fold_sign(behind(header.confirmed_until, stream.base)), k_tick_rice);
        // The streams that are not written yet share the rest of the packet equally.
        constexpr std::size_t k_header_bits = 64;
        const std::size_t left = 8 * room - std::min(8 * room, out.bits());
        const std::size_t share = left / (players - slot);
        const std::size_t length_at = out.bits();
        out.put(0, k_length_bits);
        const std::size_t stream_at = out.bits();
        write_stream(stream, length_at + share - std::min(share, k_header_bits), out);
        out.overwrite(length_at, out.bits() - stream_at, k_length_bits);
    }
    return end_packet(out, bytes);
}

MatchRefusal read_server_packet(std::span<const std::byte> bytes, std::size_t players,
                                const ServerPacketSource& source, ServerPacket& out) {
    std::span<const std::byte> payload;
    if (const MatchRefusal refusal =
            open_packet(bytes, PacketKind::server, k_most_packet_bytes, payload);
        refusal != MatchRefusal::none) {
        return refusal;
    }
    BitReader in = read_frame(payload);
    out.slot = in.take_as<std::uint8_t>(k_slot_bits);
    if (out.slot != source.own_slot) {
        return MatchRefusal::sender;
    }
    out.state_epoch = in.take_as<std::uint8_t>(k_epoch_bits);
    if (out.state_epoch != source.state_epoch) {
        return MatchRefusal::window;
    }
    out.confirmed_until = in.take(k_tick_bits);
    out.received_until = tick_behind(out.confirmed_until, in.take_rice(k_tick_rice));
    out.lead_epoch = in.take_as<std::uint8_t>(k_lead_epoch_bits);
    constexpr std::int32_t k_most = (1 << (k_wait_bits - 1)) - 1;
    out.wait_s = (in.take_as<std::int32_t>(k_wait_bits) - k_most) / k_waits_per_s;
    out.is_out_of_sync = in.take_flag();
    out.gaps = 0;
    for (std::size_t slot = 0; slot < players; ++slot) {
        StreamPart& part = out.streams[slot];
        part.base = tick_behind(out.confirmed_until, in.take_rice(k_tick_rice));
        const auto length = in.take_as<std::size_t>(k_length_bits);
        if (in.has_failed() || length > in.bits_left()) {
            return MatchRefusal::malformed;
        }
        const std::size_t left = in.bits_left() - length;
        const InputHistory& history = source.histories[slot];
        if (part.base > history.final_until()) {
            // Its inputs are encoded against some that are missing.
            part.count = 0;
            ++out.gaps;
            in.skip(length);
            continue;
        }
        if (part.base + k_oldest < history.final_until()) {
            return MatchRefusal::window;
        }
        if (const MatchRefusal refusal =
                StreamReader(history, part).read(true, slot == source.own_slot, in);
            refusal != MatchRefusal::none) {
            return refusal;
        }
        if (in.bits_left() != left) {
            return MatchRefusal::malformed;
        }
    }
    return is_at_end(in) ? MatchRefusal::none : MatchRefusal::malformed;
}

}  // namespace handhold

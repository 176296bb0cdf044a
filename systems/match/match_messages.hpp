#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "systems/match/shared/bit_stream.hpp"
#include "systems/match/shared/hash_marks.hpp"
#include "systems/match/shared/input_history.hpp"
#include "systems/match/shared/match_input.hpp"

// The datagrams of a match. Whatever arrives is parsed as hostile: a message is accepted as a whole
// or refused with a reason, and no number in it leads to more memory.
namespace handhold {

inline constexpr std::size_t k_most_packet_bytes = 1200;
inline constexpr std::uint8_t k_match_version = 2;
// Ticks travel as 32 bits, and no match begins after this one.
inline constexpr MatchTick k_last_start_tick = 0xffffffff - 2 * InputHistory::k_capacity;

enum class MatchRefusal : std::uint8_t {
    none,
    size,       // shorter than any message, or longer than k_most_packet_bytes
    checksum,   // damaged
    version,    // another version of this format, or another kind of message
    sender,     // another slot than the sender's or the receiver's
    malformed,  // fields out of range, or bits beyond them
    gap,        // begins after inputs that are not here; of a server's packet, one slot's part
    window,     // ticks that are too old or too far ahead
    state,      // the state of a joining player cannot be restored here
};
inline constexpr std::size_t k_match_refusals = 9;
// Number of refused messages by reason.
using RefusalCounts = std::array<std::uint64_t, k_match_refusals>;

// Inputs of one slot for the ticks after `base`, in order.
struct StreamPart {
    static constexpr std::size_t k_most = 64;
    struct Entry {
        MatchInput input;
        bool is_filled = false;  // the server's prediction, which is not sent
        bool is_sent = true;     // false: as the receiver itself sent it
    };
    MatchTick base = 0;
    std::size_t count = 0;
    std::array<Entry, k_most> entries;
};

struct ClientHeader {
    std::uint8_t slot = 0;
    std::uint8_t state_epoch = 0;  // number of states that the client has joined with, modulo 4
    // Of each slot, the tick up to which the client has its final inputs.
    std::array<MatchTick, k_most_match_players> known_until{};
    std::uint8_t lead_epoch = 0;  // TickPacer::epoch
    bool wants_state = false;
    bool is_fresh = false;    // the inputs before own.base are forgotten: they count as away
    MatchTick hash_tick = 0;  // 0: no hash
    std::uint64_t hash = 0;   // hash_simulated of a confirmed tick
};
struct ClientPacket : ClientHeader {
    StreamPart own;
};

struct ServerHeader {
    std::uint8_t slot = 0;          // the receiver's
    std::uint8_t state_epoch = 0;   // ClientPacket::state_epoch that the server expects
    MatchTick confirmed_until = 0;  // no input up to this tick is missing
    MatchTick received_until = 0;   // all inputs that the receiver sent up to this tick are here
    // By how much the receiver's inputs came before their deadlines, at least, of late; s.
    // Negative: too late.
    double wait_s = 0.0;
    std::uint8_t lead_epoch = 0;  // ClientPacket::lead_epoch of these inputs
    bool is_out_of_sync = false;  // the receiver needs a new state
};
struct ServerPacket : ServerHeader {
    std::uint32_t gaps = 0;  // streams that are left out, because they begin after a gap
    std::array<StreamPart, k_most_match_players> streams;
};

// What a stream's part is encoded from.
struct StreamSource {
    const InputHistory* history = nullptr;
    MatchTick base = 0;
    MatchTick until = 0;            // the newest input; after writing, the last one in the message
    bool is_receivers_own = false;  // the server's echo to its sender: inputs need not be sent
    bool is_fresh = false;          // ClientPacket::is_fresh
};

// Writes a message of at most bytes.size() bytes and returns its size. Precondition: 64 bytes a
// player or more. Inputs that do not fit are left out, the newest first.
std::size_t write_client_packet(const ClientHeader& header, std::size_t players, StreamSource& own,
                                std::span<std::byte> bytes);
std::size_t write_server_packet(const ServerHeader& header, std::size_t players,
                                std::span<StreamSource> streams, std::span<std::byte> bytes);

// What a server reads a message against.
struct ClientPacketSource {
    std::uint8_t slot = 0;                    // the sender's
    std::span<const InputHistory> histories;  // the server's, indexed by slot
    // What the server has received of each player, also if it came late: a client's inputs are
    // encoded against these.
    std::span<const InputHistory> sent;
    std::span<const std::uint8_t> state_epochs;  // ClientPacket::state_epoch of each slot
};
// Reads a message. Messages of another state_epoch are MatchRefusal::window: they were written
// before the sender or the receiver joined. On refusal `out` is not to be used.
MatchRefusal read_client_packet(std::span<const std::byte> bytes, std::size_t players,
                                const ClientPacketSource& source, ClientPacket& out);
// What a client reads a message against.
struct ServerPacketSource {
    std::span<const InputHistory> histories;  // the client's, indexed by slot
    std::size_t own_slot = 0;
    std::uint8_t state_epoch = 0;
};
MatchRefusal read_server_packet(std::span<const std::byte> bytes, std::size_t players,
                                const ServerPacketSource& source, ServerPacket& out);

// The checksum of messages and of states of joining players.
std::uint32_t match_checksum(std::span<const std::byte> bytes);

}  // namespace handhold

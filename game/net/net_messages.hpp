#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

// What server and peers say to each other, besides the match's own packets, which are carried as
// they are: docs/reference/match_protocol.md. Whatever arrives is read as hostile: a message is
// read as a whole or not at all, and no number in it leads to more memory.
namespace handhold {

inline constexpr std::uint16_t k_net_version = 3;

// What must be equal on all machines, in the order in which differences are reported.
enum class MatchDigest : std::uint8_t { library, scene, tick, tuning, clips, bodies, shapes };
inline constexpr std::size_t k_match_digests = 7;
using MatchDigests = std::array<std::uint64_t, k_match_digests>;
// "tuning", for an error.
std::string_view digest_name(std::size_t digest);
// Index of the first digest that differs; nullopt: none does.
std::optional<std::size_t> first_difference(const MatchDigests& a, const MatchDigests& b);

// The first byte of a message.
enum class NetKind : std::uint8_t {
    offer = 1,    // server: what is played; the first message of a connection
    refused = 2,  // server: no; it closes the connection
    welcome = 3,  // server: the peer's slot
    state = 4,    // server: a piece of a join state
    packet = 5,   // both: a packet of the match
    bye = 6,      // both: the connection ends
    inputs = 7,   // server, to spectators: hh_match_confirmed_inputs
    packed = 8,   // server: a piece of a join state that pack_state has made smaller
    hello = 16,   // peer: wants to play
    joined = 17,  // peer: the state is restored
};

struct MatchOffer {
    std::uint16_t version = k_net_version;
    std::uint8_t players = 0;  // slots of the match
    std::uint64_t seed = 0;    // seed of the places where they begin
    bool wants_token = false;
    MatchDigests digests{};
    std::string scene;  // a built-in scene's name, or any other name, which is not a file to open
};

struct MatchHello {
    std::uint16_t version = k_net_version;
    std::uint64_t person = 0;  // random, the same when the person returns
    bool watches = false;      // a spectator, who has no slot
    bool unpacks = false;      // takes packed states
    MatchDigests digests{};
    std::string token;
};

enum class NetRefusal : std::uint8_t {
    version = 1,    // `detail`: the server's version
    level = 2,      // `detail`: a MatchDigest
    full = 3,       // all slots are played or reserved
    no_token = 4,   // a token is needed
    bad_token = 5,  // not one of this server
    expired_token = 6,
    draining = 7,  // the server ends
    malformed = 8,
    busy = 9,  // too many have joined of late
};
inline constexpr std::size_t k_net_refusals = 10;  // length of an array by NetRefusal
struct MatchRefused {
    NetRefusal reason = NetRefusal::malformed;
    std::uint16_t detail = 0;
};
// "other level: \"tuning\" differs"; one line.
std::string refusal_text(const MatchRefused& refused);

struct MatchWelcome {
    static constexpr std::uint8_t k_no_slot = 255;  // a spectator's

    std::uint8_t slot = 0;
};

// A piece of a join state. Pieces come in order.
struct StatePiece {
    static constexpr std::size_t k_most_bytes = std::size_t{8} << 10U;
    static constexpr std::uint32_t k_most_total = std::uint32_t{32} << 20U;

    std::uint8_t number = 0;  // the state's number; `joined` repeats it
    std::uint32_t total = 0;  // bytes of the whole state
    std::uint32_t offset = 0;
    std::span<const std::byte> bytes;  // a part of the message
    bool is_packed = false;            // the kind of the message: state or packed
};

enum class NetBye : std::uint8_t {
    leaving = 1,   // the player leaves
    draining = 2,  // the server ends
    replaced = 3,  // the same person has connected again
    silent = 4,    // no input came for long
    late = 5,      // the state was not restored in time
};
std::string_view bye_text(NetBye bye);

// The kind of a message; nullopt for other bytes.
std::optional<NetKind> kind_of(std::span<const std::byte> message);
// A packet's message, and the packet in it. Precondition of the latter: kind_of is packet or
// inputs.
void write_packet_message(std::span<const std::byte> packet, std::vector<std::byte>& message);
// Likewise for confirmed inputs.
void write_inputs_message(std::span<const std::byte> inputs, std::vector<std::byte>& message);
inline std::span<const std::byte> packet_in(std::span<const std::byte> message) {
    return message.subspan(1);
}

// Each overwrites `message`. Precondition: texts have at most k_most_text_bytes.
inline constexpr std::size_t k_most_text_bytes = 512;
void write_message(const MatchOffer& offer, std::vector<std::byte>& message);
void write_message(const MatchHello& hello, std::vector<std::byte>& message);
void write_message(const MatchRefused& refused, std::vector<std::byte>& message);
void write_message(const MatchWelcome& welcome, std::vector<std::byte>& message);
void write_message(const StatePiece& piece, std::vector<std::byte>& message);
void write_message(NetBye bye, std::vector<std::byte>& message);
void write_joined(std::uint8_t number, std::vector<std::byte>& message);

// nullopt for bytes that no write_message has written. Offers and hellos of another version have
// nothing but their version.
std::optional<MatchOffer> read_offer(std::span<const std::byte> message);
std::optional<MatchHello> read_hello(std::span<const std::byte> message);
std::optional<MatchRefused> read_refused(std::span<const std::byte> message);
std::optional<MatchWelcome> read_welcome(std::span<const std::byte> message);
std::optional<StatePiece> read_state_piece(std::span<const std::byte> message);
std::optional<NetBye> read_bye(std::span<const std::byte> message);
std::optional<std::uint8_t> read_joined(std::span<const std::byte> message);

}  // namespace handhold

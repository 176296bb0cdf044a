#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "systems/match/match_messages.hpp"
#include "systems/match/shared/bit_stream.hpp"

// What all packets of a match have around their content: kind and version before it, a checksum
// after it.
namespace handhold {

enum class PacketKind : std::uint8_t { client = 1, server = 2, confirmed = 3 };

inline constexpr std::size_t k_checksum_bytes = 4;

void begin_packet(PacketKind kind, BitWriter& out);
// Adds the checksum to what was written into `bytes`, which has room for it. Returns the size.
std::size_t end_packet(const BitWriter& out, std::span<std::byte> bytes);

// Checks size, checksum, kind and version. `payload` gets the bytes without the checksum.
MatchRefusal open_packet(std::span<const std::byte> bytes, PacketKind kind, std::size_t most_bytes,
                         std::span<const std::byte>& payload);
// Reads the content of an opened packet.
BitReader read_frame(std::span<const std::byte> payload);
// True if nothing but the padding of the last byte is left, and that is zero.
bool is_at_end(BitReader& in);

}  // namespace handhold

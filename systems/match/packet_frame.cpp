#include "systems/match/packet_frame.hpp"

#include <algorithm>

#include "engine/core/hash.hpp"

namespace handhold {
namespace {

constexpr unsigned k_kind_bits = 3;
constexpr unsigned k_version_bits = 5;

}  // namespace

void begin_packet(PacketKind kind, BitWriter& out) {
    out.put(static_cast<std::uint64_t>(kind), k_kind_bits);
    out.put(k_match_version, k_version_bits);
}

std::size_t end_packet(const BitWriter& out, std::span<std::byte> bytes) {
    const std::size_t size = out.bytes();
    const std::uint32_t sum = match_checksum(bytes.first(size));
    for (std::size_t i = 0; i < k_checksum_bytes; ++i) {
        bytes[size + i] = static_cast<std::byte>((sum >> (8 * i)) & 0xffU);
    }
    return size + k_checksum_bytes;
}

MatchRefusal open_packet(std::span<const std::byte> bytes, PacketKind kind, std::size_t most_bytes,
                         std::span<const std::byte>& payload) {
    if (bytes.size() < 2 + k_checksum_bytes || bytes.size() > most_bytes) {
        return MatchRefusal::size;
    }
    payload = bytes.first(bytes.size() - k_checksum_bytes);
    std::uint32_t sum = 0;
    for (std::size_t i = 0; i < k_checksum_bytes; ++i) {
        sum |= std::to_integer<std::uint32_t>(bytes[payload.size() + i]) << (8 * i);
    }
    if (sum != match_checksum(payload)) {
        return MatchRefusal::checksum;
    }
    BitReader in(payload);
    const auto found = in.take(k_kind_bits);
    const auto version = in.take(k_version_bits);
    return found == static_cast<std::uint64_t>(kind) && version == k_match_version
               ? MatchRefusal::none
               : MatchRefusal::version;
}

BitReader read_frame(std::span<const std::byte> payload) {
    BitReader in(payload);
    in.take(k_kind_bits + k_version_bits);
    return in;
}

bool is_at_end(BitReader& in) {
    return in.bits_left() < 8 && in.take(static_cast<unsigned>(in.bits_left())) == 0 &&
           !in.has_failed();
}

std::uint32_t match_checksum(std::span<const std::byte> bytes) {
    HashStream stream;
    stream.add(std::uint64_t{bytes.size()});
    for (std::size_t at = 0; at < bytes.size(); at += 8) {
        std::uint64_t word = 0;
        for (std::size_t i = 0; i < std::min<std::size_t>(8, bytes.size() - at); ++i) {
            word |= std::to_integer<std::uint64_t>(bytes[at + i]) << (8 * i);
        }
        stream.add(word);
    }
    return static_cast<std::uint32_t>(stream.value() >> 32);
}

}  // namespace handhold

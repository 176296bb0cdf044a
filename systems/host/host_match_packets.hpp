#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "systems/host/host_match.hpp"

// Packets of a match as the C interface takes and gives them.
namespace handhold {

// The slot as an index; HH_ERROR_VALUE if the match has no such slot.
inline std::size_t slot_of(const hh_match& match, std::uint32_t slot) {
    require(slot < match.def.player_count, HH_ERROR_VALUE, "no such slot");
    return slot;
}

const char* refusal_text(MatchRefusal refusal);

// Calls receive(bytes). HH_ERROR_DATA for packets that are bad; losses and packets that overtake
// each other are no errors.
template <typename Receive>
void take_packet(const void* packet, std::size_t size, const Receive& receive) {
    require(packet != nullptr || size == 0, HH_ERROR_NULL, "the packet is null");
    const MatchRefusal refusal = receive(std::span(static_cast<const std::byte*>(packet), size));
    require(refusal == MatchRefusal::none || refusal == MatchRefusal::gap ||
                refusal == MatchRefusal::window,
            HH_ERROR_DATA, refusal_text(refusal));
}

// Calls write(bytes), and sets `size` to what it returns. A null buffer only asks for the most.
template <typename Write>
void give_packet(void* buffer, std::size_t capacity, std::size_t* size, const Write& write) {
    require(size != nullptr, HH_ERROR_NULL, "the size is null");
    *size = HH_MATCH_PACKET_BYTES;
    if (buffer == nullptr) {
        return;
    }
    require(capacity >= HH_MATCH_PACKET_BYTES, HH_ERROR_CAPACITY, "the buffer is too small");
    *size = write(std::span(static_cast<std::byte*>(buffer), k_most_packet_bytes));
}

}  // namespace handhold

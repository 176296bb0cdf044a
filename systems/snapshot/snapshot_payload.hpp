#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>

#include "components/world.hpp"
#include "engine/core/result.hpp"

// The payload of a snapshot: docs/reference/snapshot_format.md, "Payload".
namespace handhold {

// Converts to and from little-endian, the byte order of snapshots.
template <typename T>
T swapped_unless_little(T value) {
    if constexpr (std::endian::native == std::endian::little) {
        return value;
    } else {
        auto bytes = std::bit_cast<std::array<std::byte, sizeof(T)>>(value);
        std::reverse(bytes.begin(), bytes.end());
        return std::bit_cast<T>(bytes);
    }
}

template <typename T>
T load_little(const std::byte* at) {
    T value;
    std::memcpy(&value, at, sizeof value);
    return swapped_unless_little(value);
}

template <typename T>
void store_little(T value, std::byte* at) {
    const T little = swapped_unless_little(value);
    std::memcpy(at, &little, sizeof little);
}

std::size_t payload_bytes(const World& world);
// Writes payload_bytes(world) bytes to `to`; returns their end.
std::byte* write_payload(const World& world, std::byte* to);
// Reads bytes [begin, end) of a snapshot into `world`, which must be empty. Validates each field by
// itself. On error returns the first invalid value; `world` must then be discarded.
std::optional<FileError> read_payload(std::span<const std::byte> snapshot, std::size_t begin,
                                      std::size_t end, World& world);

}  // namespace handhold

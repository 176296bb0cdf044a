#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/core/hash.hpp"
#include "engine/math/math.hpp"
#include "systems/snapshot/snapshot_schema.hpp"

// Snapshots tampered with by someone who knows the format: the checksum is valid. Written from
// docs/reference/snapshot_format.md, not from the code.
namespace handhold::test {

struct SnapshotBytes {
    std::vector<std::byte> bytes;

    explicit SnapshotBytes(std::vector<std::byte> snapshot) : bytes(std::move(snapshot)) {}

    template <typename T>
    void put(std::size_t at, T value) {
        std::memcpy(bytes.data() + at, &value, sizeof value);
        seal();
    }
    void replace_in_schema(std::string_view old_text, std::string_view new_text) {
        const std::size_t at = snapshot_schema().find(old_text);
        std::memcpy(bytes.data() + k_header_bytes + at, new_text.data(), new_text.size());
        seal();
    }
    static std::size_t payload_begin() { return k_header_bytes + snapshot_schema().size(); }
    // Byte offset behind this pose in the payload.
    std::size_t find_end_of(const Pose& pose) const {
        double numbers[7];
        std::memcpy(numbers, pose.position.data(), 3 * sizeof(double));
        std::memcpy(numbers + 3, pose.rotation.coeffs().data(), 4 * sizeof(double));
        std::size_t found = 0;
        for (std::size_t at = payload_begin(); at + sizeof numbers <= bytes.size(); ++at) {
            if (std::memcmp(bytes.data() + at, numbers, sizeof numbers) == 0) {
                found = at + sizeof numbers;
                break;
            }
        }
        return found;
    }
    // Recomputes the checksum.
    void seal() {
        if (bytes.size() < k_header_bytes + k_checksum_bytes) {
            return;
        }
        const std::size_t end = bytes.size() - k_checksum_bytes;
        HashStream stream;
        stream.add(std::uint64_t{end});
        std::size_t at = 0;
        for (; at + 8 <= end; at += 8) {
            std::uint64_t word = 0;
            std::memcpy(&word, bytes.data() + at, sizeof word);
            stream.add(word);
        }
        for (; at < end; ++at) {
            stream.add(std::to_integer<std::uint64_t>(bytes[at]));
        }
        const std::uint64_t checksum = stream.value();
        std::memcpy(bytes.data() + end, &checksum, sizeof checksum);
    }

    static constexpr std::size_t k_header_bytes = 32;
    static constexpr std::size_t k_checksum_bytes = 8;
};

}  // namespace handhold::test

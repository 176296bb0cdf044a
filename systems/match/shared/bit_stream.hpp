#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

// Reads and writes numbers of any number of bits, the lowest bit first. Neither leaves its bytes:
// beyond them a writer drops what it gets, and a reader returns zeros; both then have failed.
namespace handhold {

// Zigzag: small absolute values become small numbers.
inline std::uint32_t fold_sign(std::int32_t value) {
    return (static_cast<std::uint32_t>(value) << 1) ^ static_cast<std::uint32_t>(value >> 31);
}
inline std::int32_t unfold_sign(std::uint32_t folded) {
    return static_cast<std::int32_t>((folded >> 1) ^ (~(folded & 1U) + 1U));
}

// Quotients of Rice codes from here on are escaped: 32 plain bits follow.
inline constexpr std::uint32_t k_rice_escape = 16;

class BitWriter {
  public:
    explicit BitWriter(std::span<std::byte> bytes) : bytes_(bytes) {}

    // bits: [0, 64]; the rest of `value` must be zero.
    void put(std::uint64_t value, unsigned bits) {
        if (has_failed_ || at_ + bits > 8 * bytes_.size()) {
            has_failed_ = true;
            return;
        }
        while (bits > 0) {
            const std::size_t byte = at_ / 8;
            const auto shift = static_cast<unsigned>(at_ % 8);
            const unsigned now = std::min(bits, 8U - shift);
            const auto part = static_cast<std::uint8_t>((value & ((1U << now) - 1U)) << shift);
            const auto old =
                shift == 0 ? std::uint8_t{0} : std::to_integer<std::uint8_t>(bytes_[byte]);
            bytes_[byte] = static_cast<std::byte>(old | part);
            value >>= now;
            bits -= now;
            at_ += now;
        }
    }
    void put_flag(bool flag) { put(flag ? 1U : 0U, 1); }
    // Golomb-Rice code with the parameter k: k + 1 + value / 2^k bits.
    void put_rice(std::uint32_t value, unsigned k) {
        const std::uint32_t quotient = value >> k;
        if (quotient >= k_rice_escape) {
            put((1U << k_rice_escape) - 1U, k_rice_escape);
            put(value, 32);
            return;
        }
        put((1U << quotient) - 1U, quotient + 1);  // so many ones, then a zero
        put(value & ((1U << k) - 1U), k);
    }

    // Replaces bits that were put before.
    void overwrite(std::size_t at, std::uint64_t value, unsigned bits) {
        for (unsigned i = 0; i < bits && at + i < at_; ++i) {
            const auto bit = static_cast<std::byte>(1U << ((at + i) % 8));
            std::byte& byte = bytes_[(at + i) / 8];
            byte = ((value >> i) & 1U) != 0 ? byte | bit : byte & ~bit;
        }
    }

    std::size_t bits() const { return at_; }
    std::size_t bytes() const { return (at_ + 7) / 8; }
    bool has_failed() const { return has_failed_; }
    // Drops what was written after bits() had this value, and a failure since.
    void rewind(std::size_t bits) {
        at_ = bits;
        has_failed_ = false;
        if (at_ % 8 != 0) {  // clears the rest of the last byte
            std::byte& last = bytes_[at_ / 8];
            last &= static_cast<std::byte>((1U << (at_ % 8)) - 1U);
        }
    }

  private:
    std::span<std::byte> bytes_;
    std::size_t at_ = 0;
    bool has_failed_ = false;
};

class BitReader {
  public:
    explicit BitReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

    std::uint64_t take(unsigned bits) {
        if (has_failed_ || at_ + bits > 8 * bytes_.size()) {
            has_failed_ = true;
            return 0;
        }
        std::uint64_t value = 0;
        for (unsigned done = 0; done < bits;) {
            const auto shift = static_cast<unsigned>(at_ % 8);
            const unsigned now = std::min(bits - done, 8U - shift);
            const auto byte = std::to_integer<std::uint64_t>(bytes_[at_ / 8]);
            value |= ((byte >> shift) & ((1U << now) - 1U)) << done;
            done += now;
            at_ += now;
        }
        return value;
    }
    template <typename Integer>
    Integer take_as(unsigned bits) {
        return static_cast<Integer>(take(bits));
    }
    bool take_flag() { return take(1) != 0; }
    std::uint32_t take_rice(unsigned k) {
        std::uint32_t quotient = 0;
        while (quotient < k_rice_escape && take_flag()) {
            ++quotient;
        }
        if (quotient == k_rice_escape) {
            return take_as<std::uint32_t>(32);
        }
        return (quotient << k) | take_as<std::uint32_t>(k);
    }

    void skip(std::size_t bits) {
        has_failed_ = has_failed_ || bits > bits_left();
        at_ += has_failed_ ? 0 : bits;
    }

    bool has_failed() const { return has_failed_; }
    void fail() { has_failed_ = true; }
    std::size_t bits_left() const { return 8 * bytes_.size() - at_; }

  private:
    std::span<const std::byte> bytes_;
    std::size_t at_ = 0;
    bool has_failed_ = false;
};

}  // namespace handhold

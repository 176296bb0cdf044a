#pragma once

#include <bit>
#include <cstdint>
#include <string_view>

// Hashes that are equal on every compiler, build and machine. They are used to identify entities
// and to compare states.
namespace handhold {

// Mixes 64 bits so that every input bit flips about half of the output bits (SplitMix64 finaliser,
// Steele 2014).
constexpr std::uint64_t mix64(std::uint64_t x) {
    x ^= x >> 30;
    x *= 0xbf58476d1ce4e5b9ULL;
    x ^= x >> 27;
    x *= 0x94d049bb133111ebULL;
    x ^= x >> 31;
    return x;
}

// FNV-1a, 64 bits.
constexpr std::uint64_t hash_text(std::string_view text) {
    std::uint64_t hash = 0xcbf29ce484222325ULL;
    for (const char c : text) {
        hash ^= static_cast<unsigned char>(c);
        hash *= 0x100000001b3ULL;
    }
    return hash;
}

// Order-dependent hash of a sequence of plain values. It uses their bits: -0.0 and 0.0 differ, and
// two NaNs may differ.
class HashStream {
  public:
    void add(std::uint64_t value) { state_ = mix64(state_ ^ mix64(value + 0x9e3779b97f4a7c15ULL)); }
    void add(double value) { add(std::bit_cast<std::uint64_t>(value)); }
    std::uint64_t value() const { return state_; }

  private:
    std::uint64_t state_ = 0x243f6a8885a308d3ULL;
};

}  // namespace handhold

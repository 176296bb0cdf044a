#pragma once

#include <array>
#include <bit>
#include <cstdint>

namespace handhold {

// Four floats that are added, multiplied and compared at once, as four.hpp's doubles: for what only
// has to tell far from near, with room to spare for what floats round off.
using FourFloats = float __attribute__((vector_size(16)));

// What comparisons of them give: each 0 or -1.
using FourInts = std::int32_t __attribute__((vector_size(16)));

// Four triangles side by side, by corner and coordinate.
using FourCorners = std::array<std::array<FourFloats, 3>, 3>;

inline FourFloats four_times(double value) {
    const auto rounded = static_cast<float>(value);
    return FourFloats{rounded, rounded, rounded, rounded};
}
inline FourFloats lower(const FourFloats& a, const FourFloats& b) { return a < b ? a : b; }
inline FourFloats higher(const FourFloats& a, const FourFloats& b) { return a > b ? a : b; }

inline bool any_of(const FourInts& is_so) {
    const auto halves = std::bit_cast<std::array<std::uint64_t, 2>>(is_so);
    return (halves[0] | halves[1]) != 0;
}
// True where any of four numbers is beyond its limit.
inline bool any_beyond(const FourFloats& values, const FourFloats& limits) {
    return any_of(values > limits);
}

}  // namespace handhold

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

// Four vectors side by side, by coordinate; and the corners of four triangles.
using FourVectors = std::array<FourFloats, 3>;
using FourCorners = std::array<FourVectors, 3>;

inline FourFloats four_times(float value) { return FourFloats{value, value, value, value}; }
inline FourFloats four_times(double value) { return four_times(static_cast<float>(value)); }
inline FourFloats lower(const FourFloats& a, const FourFloats& b) { return a < b ? a : b; }
inline FourFloats higher(const FourFloats& a, const FourFloats& b) { return a > b ? a : b; }

inline FourFloats dot(const FourVectors& a, const FourVectors& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline FourVectors cross(const FourVectors& a, const FourVectors& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

inline bool any_of(const FourInts& is_so) {
    const auto halves = std::bit_cast<std::array<std::uint64_t, 2>>(is_so);
    return (halves[0] | halves[1]) != 0;
}
}  // namespace handhold

#pragma once

#include <array>
#include <bit>
#include <cstdint>

namespace handhold {

// Four floats that are added, multiplied and compared at once, as four.hpp's doubles: for what only
// has to tell far from near, with room to spare for what floats round off.
using FourFloats = float __attribute__((vector_size(16)));

// True where any of four numbers is beyond its limit.
inline bool any_beyond(const FourFloats& values, const FourFloats& limits) {
    using FourInts = std::int32_t __attribute__((vector_size(16)));
    const FourInts beyond = values > limits;
    const auto halves = std::bit_cast<std::array<std::uint64_t, 2>>(beyond);
    return (halves[0] | halves[1]) != 0;
}

// Around a box in a plane: its lowest x and y, its highest x and y less than zero. It is
// `any_beyond` the limits of another one where the two are apart.
struct FlatBounds {
    FourFloats value = {};
};

}  // namespace handhold

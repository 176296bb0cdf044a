#pragma once

#include <array>
#include <bit>
#include <cstdint>

namespace handhold {

// Four floats processed together. For rejection tests with a rounding margin, and for body networks
// (systems/body/shared), which compute state with it: no operation may be fused, reordered or
// flushed to zero. Other results are computed in doubles (double4.hpp).
using Float4 = float __attribute__((vector_size(16)));

// Result of comparisons: each lane is 0 or -1.
using Int4 = std::int32_t __attribute__((vector_size(16)));

// Four vectors: [coordinate][vector]. Four triangles: [corner][coordinate][triangle].
using Vectors4 = std::array<Float4, 3>;
using Corners4 = std::array<Vectors4, 3>;

inline Float4 splat4(float value) { return Float4{value, value, value, value}; }
inline Float4 splat4(double value) { return splat4(static_cast<float>(value)); }
inline Float4 lower(const Float4& a, const Float4& b) { return a < b ? a : b; }
inline Float4 higher(const Float4& a, const Float4& b) { return a > b ? a : b; }

inline Float4 dot(const Vectors4& a, const Vectors4& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Vectors4 cross(const Vectors4& a, const Vectors4& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

inline bool any_of(const Int4& mask) {
    const auto halves = std::bit_cast<std::array<std::uint64_t, 2>>(mask);
    return (halves[0] | halves[1]) != 0;
}
}  // namespace handhold

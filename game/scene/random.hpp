#pragma once

#include <cstdint>

#include <handhold/handhold.hpp>
#include <handhold/math.hpp>

#include "engine/core/hash.hpp"

namespace handhold {

// A random number generator (SplitMix64: a counter through a mixer) with equal results on every
// machine. The distributions of <random> differ between libraries. A copy continues with the same
// numbers.
class Random {
  public:
    explicit Random(std::uint64_t seed = 0) : state_(seed) {}
    // Seeds that differ by little, such as 1 and 2, give unrelated numbers.
    static Random of(std::uint64_t seed) { return Random(mix64(seed)); }

    std::uint64_t bits() {
        state_ += 0x9e3779b97f4a7c15ULL;
        return mix64(state_);
    }
    // [0, 1)
    double unit() { return static_cast<double>(bits() >> 11U) * 0x1.0p-53; }
    // [low, high)
    double between(double low, double high) { return low + (high - low) * unit(); }
    bool chance(double probability) { return unit() < probability; }
    // Each component in [-1, 1).
    hh::Vec3 cube() {
        const double x = between(-1.0, 1.0);
        const double y = between(-1.0, 1.0);
        const double z = between(-1.0, 1.0);
        return {x, y, z};
    }
    // A unit vector, uniform over the sphere.
    hh::Vec3 direction() {
        for (;;) {
            const hh::Vec3 v = cube();
            const double length = hh::length(v);
            constexpr double k_too_short = 1e-3;
            if (length > k_too_short && length <= 1.0) {
                return v / length;
            }
        }
    }

  private:
    std::uint64_t state_;
};

}  // namespace handhold

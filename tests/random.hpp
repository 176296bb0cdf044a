#pragma once

#include <cstdint>
#include <random>

#include "engine/math/math.hpp"

namespace handhold::test {

// Random numbers that are the same everywhere. One expression draws at most once, or in a braced
// list: compilers order arguments and operands as they like (tools/check_draws.py).
class Random {
  public:
    explicit Random(std::uint64_t seed) : engine_(seed) {}
    // Uniform; the standard distributions differ between libraries.
    double between(double low, double high) {
        return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53;
    }
    Vec3 vector(double size) {
        return {between(-size, size), between(-size, size), between(-size, size)};
    }
    Vec3 direction() {
        for (;;) {
            const Vec3 v = vector(1.0);
            if (v.norm() > 0.1 && v.norm() < 1.0) {
                return v.normalized();
            }
        }
    }
    // In any direction, of uniform length.
    Vec3 arm(double low, double high) {
        const double length = between(low, high);
        return length * direction();
    }
    Quat rotation() {
        const Vec3 axis = direction();  // first: compilers order arguments as they like
        return rotation_about(axis, between(-3.0, 3.0));
    }
    Pose pose(double size_m = 2.0) {
        const Vec3 position = vector(size_m);
        return {position, rotation()};
    }
    std::mt19937_64& engine() { return engine_; }

  private:
    std::mt19937_64 engine_;
};

}  // namespace handhold::test

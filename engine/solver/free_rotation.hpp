#pragma once

#include <array>
#include <cstddef>

#include "engine/math/math.hpp"
#include "engine/math/processor.hpp"

namespace handhold {

// Turns bodies on which nothing acts by dt_s, four at a time; what happens to one does not depend
// on the other three. Keeps the angular momentum to rounding and the energy to a fraction that does
// not grow with time, up to 64 rad in dt_s; what claims to spin at 1e6 rad/s or more stays as it
// is; exact for spheres and symmetric tops. The energy is split after Dullweber, Leimkuhler and
// McLachlan (1997, J. Chem. Phys. 107, 5840), with the part all three moments share taken out
// first, which commutes with the rest.
class FreeRotations {
  public:
    explicit FreeRotations(double dt_s, Vectors vectors = fastest_vectors())
        : dt_s_(dt_s), vectors_(vectors) {}

    // `rotation` body to world, `spin_radps` in world axes, principal moments all > 0. Both are
    // written by the time of `finish`, not before: they must stay where they are.
    void add(const Vec3& inertia_kgm2, Quat& rotation, Vec3& spin_radps);
    void finish();

  private:
    struct Body {
        const Vec3* inertia_kgm2 = nullptr;
        Quat* rotation = nullptr;
        Vec3* spin_radps = nullptr;
    };
    struct Batch {
        std::array<Body, 4> bodies;
        std::size_t count = 0;
    };
    enum class Kind : std::size_t { top, any };  // two equal moments, or three different ones
    void advance(Kind kind);

    double dt_s_;
    Vectors vectors_;
    std::array<Batch, 2> batches_;  // by kind
};

}  // namespace handhold

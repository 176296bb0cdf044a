#pragma once

#include <array>
#include <cstddef>

#include "engine/math/math.hpp"
#include "engine/math/processor.hpp"
#include "engine/math/wide.hpp"

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

    // Bodies are turned so many fours at once: what was written number by number has reached the
    // cache before it is read four at a time.
    static constexpr std::size_t k_fours = 8;
    // Lane i is the i-th of four bodies.
    struct FreeRotation4 {
        Wide3 inertia;
        Wide4 rotation;
        Wide3 spin;
    };

  private:
    static constexpr std::size_t k_lanes = 4;
    static constexpr std::size_t k_batch = k_fours * k_lanes;
    struct Out {
        Quat* rotation = nullptr;
        Vec3* spin_radps = nullptr;
    };
    struct Batch {
        std::array<FreeRotation4, k_fours> fours;
        std::array<Out, k_batch> out;
        std::size_t count = 0;
    };
    enum class Kind : std::size_t { top, any };  // two equal moments, or three different ones
    static void write(std::size_t place, const Vec3& inertia_kgm2, const Quat& rotation,
                      const Vec3& spin_radps, Batch& batch);
    void advance(Kind kind);

    double dt_s_;
    Vectors vectors_;
    std::array<Batch, 2> batches_;  // by kind
};

}  // namespace handhold

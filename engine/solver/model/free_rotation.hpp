// Solver, model: torque-free rotation of rigid bodies, used to predict poses before the solve.

#pragma once

#include <array>
#include <cstddef>

#include "engine/math/math.hpp"
#include "engine/math/processor.hpp"
#include "engine/math/wide.hpp"

namespace handhold {

inline constexpr double k_fastest_spin_radps = 1e6;

// Rotates torque-free bodies by dt_s, four at a time. The result of a body does not depend on the
// other three. Angular momentum is kept to rounding. The energy error is bounded and does not grow
// with time, for rotations up to 64 rad per dt_s. Exact for spheres and symmetric tops. A body with
// a spin of k_fastest_spin_radps or more is left unchanged.
//
// Method: energy splitting after Dullweber, Leimkuhler and McLachlan (1997, J. Chem. Phys. 107,
// 5840). The rotation common to all three axes is factored out first; it commutes with the rest.
class FreeRotations {
  public:
    explicit FreeRotations(double dt_s, Vectors vectors = fastest_vectors())
        : dt_s_(dt_s), vectors_(vectors) {}

    // `rotation` maps body to world, `spin_radps` is in world axes, all principal moments are > 0.
    // Both references are written no later than `finish` and must stay valid until then.
    void add(const Vec3& inertia_kgm2, Quat& rotation, Vec3& spin_radps);
    void finish();

    // Groups of four processed per batch. Batching lets the scalar stores reach the cache before
    // the vector loads read them.
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
    std::array<Batch, 2> batches_;  // indexed by kind
};

}  // namespace handhold

#pragma once

#include "engine/math/math.hpp"

namespace handhold {

// Turns a body on which nothing acts by dt_s: `rotation` body to world, `spin_radps` in world axes,
// principal moments all > 0. Keeps the angular momentum to rounding and the energy to a fraction
// that does not grow with time, up to 64 rad in dt_s; what claims to spin at 1e6 rad/s or more
// stays as it is; exact for spheres and symmetric tops. The energy is split after Dullweber,
// Leimkuhler and McLachlan (1997, J. Chem. Phys. 107, 5840), with the part all three moments share
// taken out first, which commutes with the rest.
void advance_rotation(const Vec3& inertia_kgm2, double dt_s, Quat& rotation, Vec3& spin_radps);

}  // namespace handhold

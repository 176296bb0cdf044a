#pragma once

#include "engine/math/math.hpp"

namespace handhold {

// How a force resists the turning of its own arm, as an addition to the body's inertia: the part of
// (l.r) I - sym(l r^T) (sign +1) or of its negative (-1) with eigenvalues above zero. N m; `force`
// (N) and `arm` (m) in the same axes. Source: Tournier, Nesme, Gilles and Faure, Stable Constrained
// Dynamics (2015).
Mat3 positive_stiffness(const Vec3& force, const Vec3& arm, double sign);

// The inverse of what an inverse inertia becomes with it.
Mat3 stiffened(const Mat3& inverse_inertia, const Mat3& stiffness);

}  // namespace handhold

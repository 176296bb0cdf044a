// Solver, newton: geometric stiffness for one body at a time. packed/triad_bodies.hpp evaluates the
// same expression for four bodies at a time. It is a separate routine because it is rearranged to
// one division and no normalisation for all four lanes, which rounds differently; a shared template
// would change the bits of one of the two. tests/engine/solver/stiffness_test.cpp compares them.

#pragma once

#include "engine/math/math.hpp"

namespace handhold {

// Resistance of a force to the rotation of its own lever arm, to be added to the body's inertia:
// the positive semidefinite part of (l.r) I - sym(l r^T) (sign +1) or of its negative (-1). l:
// force (N), r: arm from the centre to the point (m), both in the same axes. N m. Source: Tournier,
// Nesme, Gilles and Faure, Stable Constrained Dynamics (2015).
Mat3 positive_stiffness(const Vec3& force, const Vec3& arm, double sign);

// (I + stiffness)^-1, given I^-1.
Mat3 stiffened(const Mat3& inverse_inertia, const Mat3& stiffness);

}  // namespace handhold

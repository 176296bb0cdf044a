// Solver, newton: geometric stiffness for one body at a time. packed/triad_bodies.hpp evaluates the
// same expression for four bodies at a time. It stays a separate routine because it is rearranged
// to one division for all lanes, which rounds differently: sharing it changes state hashes (the
// playground's after 40 s). tests/engine/solver/newton/stiffness_test.cpp compares the two.

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

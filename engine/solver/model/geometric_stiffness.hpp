// Solver, model: geometric stiffness, the resistance of a force to the rotation of its own lever
// arm. It is added to the body's inertia, which keeps Newton's method from oscillating if mass
// ratios are large. (The time step of the position solve is 1, so that N m and kg m^2 are the same
// unit.) Packed kernels call the four-lane routine, RowSteps the scalar one, which uses one lane of
// it. Source: Tournier, Nesme, Gilles and Faure, Stable Constrained Dynamics (2015).

#pragma once

#include "engine/math/math.hpp"
#include "engine/math/wide.hpp"

namespace handhold {

// out += factor * v v^T
HH_INLINE void add_outer(const Wide3& v, const Double4& factor, WideSymmetric& out) {
    const Wide3 scaled = factor * v;
    out.xx += scaled.x * v.x;
    out.yy += scaled.y * v.y;
    out.zz += scaled.z * v.z;
    out.xy += scaled.x * v.y;
    out.xz += scaled.x * v.z;
    out.yz += scaled.y * v.z;
}

// out += the positive semidefinite part of S = (l.r) I - sym(l r^T); l: `force` (N), r: `arm` (m),
// in the same axes; four forces at a time. With a reversed arm, the positive semidefinite part of
// -S is added.
//
// Closed form: the eigenvectors are l/|l| - r/|r|, l/|l| + r/|r| and l x r. If l and r are
// parallel, as in a taut rope, every direction perpendicular to them is an eigenvector.
HH_INLINE void add_positive_stiffness(const Wide3& force, const Wide3& arm, WideSymmetric& out) {
    constexpr double k_min_ratio = 1e-12;
    const Double4 zero = zero4();
    const Double4 force_square = dot(force, force);
    const Double4 arm_square = dot(arm, arm);
    const Double4 product = square_root(force_square * arm_square);
    const Double4 along = dot(force, arm);
    const Wide3 normal = cross(force, arm);
    const Double4 normal_square = dot(normal, normal);
    const Mask4 is_nonzero = product >= k_min_ratio;
    const Mask4 pulls = along > 0.0;
    const Mask4 is_straight = pulls & (normal_square <= k_min_ratio * product * product);
    const Double4 ratio = is_nonzero ? product / arm_square : zero;
    const Wide3 difference = force - ratio * arm;
    const Wide3 axis{is_straight ? force.x : difference.x, is_straight ? force.y : difference.y,
                     is_straight ? force.z : difference.z};
    // One division for two quotients; unused lanes divide by 1.
    const Mask4 has_normal = pulls & ~is_straight;
    const Double4 one = zero + 1.0;
    const Double4 axis_size = is_straight ? force_square : dot(difference, difference);
    const Double4 normal_size = has_normal ? normal_square : one;
    const Double4 by = 1.0 / (axis_size * normal_size);
    const Double4 of_axis = (is_straight ? -product : 0.5 * (product + along)) * (normal_size * by);
    const Double4 of_normal = has_normal ? along * (axis_size * by) : zero;
    const Double4 of_all = (is_nonzero & is_straight) ? product : zero;
    add_outer(axis, is_nonzero ? of_axis : zero, out);
    add_outer(normal, is_nonzero ? of_normal : zero, out);
    out.xx += of_all;
    out.yy += of_all;
    out.zz += of_all;
}

// add_positive_stiffness for one force. `sign`: +1, or -1 for the positive semidefinite part of -S.
Mat3 positive_stiffness(const Vec3& force, const Vec3& arm, double sign);

// Positive semidefinite stiffness of a limit of the angle q between two axes, for the body of
// `axis`; `torque`: multiplier of q in N m, positive if it keeps q from growing. Rotating `axis` by
// s about t, the direction perpendicular to `axis` in the plane of both axes, changes q by
//   1/2 s^2 cot(q)
// so that the stiffness is torque cot(q) t t^T. It is large in narrow cones. Unit axes.
Mat3 cone_stiffness(double torque, const Vec3& axis, const Vec3& other);

// (I + stiffness)^-1, given I^-1.
Mat3 stiffened(const Mat3& inverse_inertia, const Mat3& stiffness);

}  // namespace handhold

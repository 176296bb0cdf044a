// Solver, model: geometric stiffness of one body.
#include "engine/solver/model/geometric_stiffness.hpp"

#include <algorithm>

namespace handhold {

Mat3 positive_stiffness(const Vec3& force, const Vec3& arm, double sign) {
    const Double4 zero = zero4();
    Wide3 forces{zero, zero, zero};
    Wide3 arms{zero, zero, zero};
    set_lane(0, force, forces);
    set_lane(0, sign * arm, arms);
    WideSymmetric sum{zero, zero, zero, zero, zero, zero};
    add_positive_stiffness(forces, arms, sum);
    Mat3 stiffness;
    stiffness << sum.xx[0], sum.xy[0], sum.xz[0],  //
        sum.xy[0], sum.yy[0], sum.yz[0],           //
        sum.xz[0], sum.yz[0], sum.zz[0];
    return stiffness;
}

Mat3 cone_stiffness(double torque, const Vec3& axis, const Vec3& other) {
    constexpr double k_min_sine = 1e-3;
    const Vec3 normal = axis.cross(other);
    const double sine = std::max(normal.norm(), k_min_sine);
    const Vec3 across = normal.cross(axis) / sine;
    const double stiffness = torque * axis.dot(other) / sine;
    return std::max(0.0, stiffness) * across * across.transpose();
}

Mat3 stiffened(const Mat3& inverse_inertia, const Mat3& stiffness) {
    if (stiffness.isZero(0.0)) {
        return inverse_inertia;
    }
    const Mat3 sum = inverse_inertia.inverse() + stiffness;
    return sum.inverse();
}

}  // namespace handhold

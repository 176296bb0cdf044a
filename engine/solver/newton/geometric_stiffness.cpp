// Solver, newton: closed form of the positive part of the geometric stiffness.
#include "engine/solver/newton/geometric_stiffness.hpp"

namespace handhold {

// The eigenvectors of (l.r) I - sym(l r^T) are l/|l| - r/|r|, l/|l| + r/|r| and l x r, l the force
// and r the arm. If l and r are parallel, as in a taut rope, every direction perpendicular to them
// is one.
Mat3 positive_stiffness(const Vec3& force, const Vec3& arm, double sign) {
    const double product = force.norm() * arm.norm();
    if (product < 1e-12) {
        return Mat3::Zero();
    }
    const double along = sign * force.dot(arm);
    const Vec3 normal = force.cross(arm);
    const double normal_square = normal.squaredNorm();
    if (along > 0.0 && normal_square <= 1e-12 * product * product) {
        const Vec3 line = force.normalized();
        return product * (Mat3::Identity() - line * line.transpose());
    }
    const Vec3 axis = force.normalized() - sign * arm.normalized();
    Mat3 sum = (0.5 * (product + along) / axis.squaredNorm()) * (axis * axis.transpose());
    if (along > 0.0) {
        sum += (along / normal_square) * (normal * normal.transpose());
    }
    return sum;
}

Mat3 stiffened(const Mat3& inverse_inertia, const Mat3& stiffness) {
    if (stiffness.isZero(0.0)) {
        return inverse_inertia;
    }
    const Mat3 sum = inverse_inertia.inverse() + stiffness;
    return sum.inverse();
}

}  // namespace handhold

#include "engine/solver/geometric_stiffness.hpp"

namespace handhold {

// In closed form: the eigenvectors are l/|l| - r/|r|, l/|l| + r/|r| and l x r.
Mat3 positive_stiffness(const Vec3& force, const Vec3& arm, double sign) {
    const double product = force.norm() * arm.norm();
    if (product < 1e-12) {
        return Mat3::Zero();
    }
    const double along = force.dot(arm);
    const Vec3 axis = force.normalized() - sign * arm.normalized();
    const Vec3 normal = force.cross(arm);
    Mat3 sum = Mat3::Zero();
    if (axis.squaredNorm() > 1e-12) {
        sum += (0.5 * (product + sign * along) / axis.squaredNorm()) * (axis * axis.transpose());
    }
    if (sign * along > 0.0 && normal.squaredNorm() > 1e-12 * product * product) {
        sum += (sign * along / normal.squaredNorm()) * (normal * normal.transpose());
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

#pragma once

#include <cmath>

#include "engine/math/math.hpp"

// Quaternion operations on scalars. Eigen loads quaternion components in pairs. If the components
// were just written one by one, such a load stalls until both stores reach the cache. This took a
// third of the time in code that builds many rotations.
namespace handhold {

// A unit vector perpendicular to a unit axis.
inline Vec3 any_perpendicular(const Vec3& axis) {
    const Vec3 other = std::abs(axis.z()) < 0.7 ? Vec3::UnitZ() : Vec3::UnitX();
    return (other - axis * axis.dot(other)).normalized();
}

// Converts a fraction of the angle between two unit vectors to a fraction of the line between them.
// `cosine` is that of the angle. Uses the first term of the series in the angle: the error is below
// 1e-4 rad if `cosine` >= 0.95.
inline double share_of_line(double share, double cosine) {
    return share * (1.0 + (1.0 - share) * (1.0 - 2.0 * share) * (1.0 - cosine) * (1.0 / 3.0));
}

// Normalises a quaternion of any non-zero length.
inline Quat unit_quat(double w, double x, double y, double z) {
    const double inverse_length = 1.0 / std::sqrt(w * w + x * x + (y * y + z * z));
    return {w * inverse_length, x * inverse_length, y * inverse_length, z * inverse_length};
}

inline Quat product(const Quat& a, const Quat& b) {
    return {a.w() * b.w() - a.x() * b.x() - (a.y() * b.y() + a.z() * b.z()),
            a.w() * b.x() + a.x() * b.w() + (a.y() * b.z() - a.z() * b.y()),
            a.w() * b.y() + a.y() * b.w() + (a.z() * b.x() - a.x() * b.z()),
            a.w() * b.z() + a.z() * b.w() + (a.x() * b.y() - a.y() * b.x())};
}

// Rotation that maps the coordinate axes onto x, y and z (orthonormal, right-handed). Source:
// Shepperd 1978, which divides by the largest component.
inline Quat rotation_from_axes(const Vec3& x, const Vec3& y, const Vec3& z) {
    const double trace = x.x() + y.y() + z.z();
    if (trace > 0.0) {
        return unit_quat(1.0 + trace, y.z() - z.y(), z.x() - x.z(), x.y() - y.x());
    }
    if (x.x() >= y.y() && x.x() >= z.z()) {
        return unit_quat(y.z() - z.y(), 1.0 + x.x() - y.y() - z.z(), x.y() + y.x(), z.x() + x.z());
    }
    if (y.y() >= z.z()) {
        return unit_quat(z.x() - x.z(), x.y() + y.x(), 1.0 + y.y() - x.x() - z.z(), y.z() + z.y());
    }
    return unit_quat(x.y() - y.x(), z.x() + x.z(), y.z() + z.y(), 1.0 + z.z() - x.x() - y.y());
}

}  // namespace handhold

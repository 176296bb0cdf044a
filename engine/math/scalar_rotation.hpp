#pragma once

#include <cmath>

#include "engine/math/math.hpp"

// Quaternions number by number. Eigen takes them two at a time, and where they were just written
// one by one the processor waits for both to reach the cache: in code that makes many rotations
// that was a third of its time.
namespace handhold {

// Unit, square to a unit axis.
inline Vec3 any_perpendicular(const Vec3& axis) {
    const Vec3 other = std::abs(axis.z()) < 0.7 ? Vec3::UnitZ() : Vec3::UnitX();
    return (other - axis * axis.dot(other)).normalized();
}

// The share of the line between two unit vectors that lies at this share of the angle between them,
// whose cosine is at least 0.95: to within 1e-4 rad of it. The first term of its series in the
// angle.
inline double share_of_line(double share, double cosine) {
    return share * (1.0 + (1.0 - share) * (1.0 - 2.0 * share) * (1.0 - cosine) * (1.0 / 3.0));
}

// Of any length but 0.
inline Quat unit_quat(double w, double x, double y, double z) {
    const double by = 1.0 / std::sqrt(w * w + x * x + (y * y + z * z));
    return {w * by, x * by, y * by, z * by};
}

inline Quat product(const Quat& a, const Quat& b) {
    return {a.w() * b.w() - a.x() * b.x() - (a.y() * b.y() + a.z() * b.z()),
            a.w() * b.x() + a.x() * b.w() + (a.y() * b.z() - a.z() * b.y()),
            a.w() * b.y() + a.y() * b.w() + (a.z() * b.x() - a.x() * b.z()),
            a.w() * b.z() + a.z() * b.w() + (a.x() * b.y() - a.y() * b.x())};
}

// The rotation that carries the axes onto these: unit, square to each other, right-handed. After
// Shepperd 1978: divides by the largest of four.
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

#pragma once

#include <cmath>

#include "engine/math/math.hpp"

// Frames along bones.
namespace handhold {

// Returns `aside`, or `other` if the bone is nearly parallel to `aside`.
inline const Vec3& choose_aside(const Vec3& along, const Vec3& aside, const Vec3& other) {
    constexpr double k_nearly = 0.98;
    return std::abs(along.normalized().dot(aside)) < k_nearly ? aside : other;
}
// Returns the rotation with +Y along the bone and +Z as close to `back` as possible.
inline Quat along_y(const Vec3& along, const Vec3& back) {
    Mat3 axes;
    axes.col(1) = along.normalized();
    axes.col(0) = Vec3(axes.col(1)).cross(back).normalized();
    axes.col(2) = Vec3(axes.col(0)).cross(Vec3(axes.col(1)));
    return Quat(axes).normalized();
}

}  // namespace handhold

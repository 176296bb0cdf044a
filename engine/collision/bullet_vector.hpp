#pragma once

#include <LinearMath/btTransform.h>

#include "engine/math/math.hpp"

// Conversions between Handhold's and Bullet's vectors and poses.
namespace handhold {

inline btVector3 to_bullet(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
inline Vec3 from_bullet(const btVector3& v) { return {v.x(), v.y(), v.z()}; }
inline btTransform to_bullet(const Pose& pose) {
    const Quat& q = pose.rotation;
    return btTransform(btQuaternion(q.x(), q.y(), q.z(), q.w()), to_bullet(pose.position));
}

}  // namespace handhold

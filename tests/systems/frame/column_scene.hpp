#pragma once

#include <cstdint>

#include "components/stats.hpp"
#include "engine/ecs/entity.hpp"
#include "engine/math/math.hpp"
#include "tests/random.hpp"

// Helpers of the systems' tests: entities by number, mirroring.
namespace handhold::test {

constexpr Entity entity(std::uint32_t number) { return {number, 1}; }
// Entities of most scenes.
inline constexpr Entity k_player = entity(0);
inline constexpr Entity k_left = entity(1);
inline constexpr Entity k_right = entity(2);
inline constexpr Entity k_wall = entity(3);
inline constexpr Entity k_ship = entity(4);

inline std::uint64_t count_of(const StageStats& stats, Fallback reason) {
    return stats.fallbacks[static_cast<std::size_t>(reason)];
}
inline std::uint64_t count_of_all(const StageStats& stats) {
    std::uint64_t sum = 0;
    for (const std::uint64_t count : stats.fallbacks) {
        sum += count;
    }
    return sum;
}

inline Pose pose_at(const Vec3& position) { return {position, Quat::Identity()}; }

// Mirrored in the plane x = 0.
inline Vec3 mirrored(const Vec3& v) { return {-v.x(), v.y(), v.z()}; }
inline Vec3 mirrored_spin(const Vec3& w) { return {w.x(), -w.y(), -w.z()}; }
inline Pose mirrored(const Pose& pose) {
    const Quat& q = pose.rotation;
    return {mirrored(pose.position), Quat(q.w(), q.x(), -q.y(), -q.z())};
}

inline double angle_between(const Quat& a, const Quat& b) {
    return rotation_to_vector(a * b.conjugate()).norm();
}
// Distance in metres plus angle in radians.
inline double distance(const Pose& a, const Pose& b) {
    return (a.position - b.position).norm() + angle_between(a.rotation, b.rotation);
}

}  // namespace handhold::test

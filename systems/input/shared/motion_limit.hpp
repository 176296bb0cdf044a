#pragma once

#include <algorithm>

#include "engine/math/math.hpp"

// How far a tracked device can have moved between two readings.
namespace handhold {

// Smaller jumps go unnoticed, and are within the noise and the timing jitter of tracking.
inline constexpr double k_unnoticed_m = 0.02;

// Distance between two poses; a radian of rotation counts as 0.1 m.
inline double travel_m(const Pose& from, const Pose& to) {
    constexpr double k_m_per_rad = 0.1;
    const Quat turn = (from.rotation.conjugate() * to.rotation).normalized();
    return std::max((to.position - from.position).norm(),
                    k_m_per_rad * rotation_to_vector(turn).norm());
}

inline bool could_move(const Pose& from, const Pose& to, double dt_s, double max_speed_mps) {
    return travel_m(from, to) <= max_speed_mps * dt_s + k_unnoticed_m;
}

}  // namespace handhold

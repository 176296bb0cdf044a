#pragma once

#include <algorithm>

#include "engine/math/math.hpp"

// How far a tracked device can have moved between two readings. `scale`: PlayerOrigin::scale, by
// which the constants are multiplied.
namespace handhold {

// Displacements up to this are not jumps: they are within the noise and the timing jitter of
// tracking.
inline constexpr double k_unnoticed_m = 0.02;

// Distance between two poses; a radian of rotation counts as k_m_per_rad.
inline constexpr double k_m_per_rad = 0.1;
inline double travel_m(const Pose& from, const Pose& to, double scale) {
    const Quat turn = (from.rotation.conjugate() * to.rotation).normalized();
    return std::max((to.position - from.position).norm(),
                    scale * k_m_per_rad * rotation_to_vector(turn).norm());
}

inline bool could_move(const Pose& from, const Pose& to, double dt_s, double max_speed_mps,
                       double scale) {
    const double limit_m = max_speed_mps * dt_s + scale * k_unnoticed_m;
    if ((to.position - from.position).norm() > limit_m) {
        return false;
    }
    // An angle is at most pi times the sine of its half, so small turns need no arc tangent.
    constexpr double k_over_pi = 3.2;
    const double sine = (from.rotation.conjugate() * to.rotation).vec().norm();
    return scale * k_m_per_rad * k_over_pi * sine <= limit_m ||
           travel_m(from, to, scale) <= limit_m;
}

inline constexpr double k_min_apart_s = 1e-3;
inline constexpr double k_max_apart_s = 0.05;

// Extrapolates two earlier poses to `t_s` at constant velocity and spin. Returns the last pose
// unchanged if the two are closer in time than k_min_apart_s, where noise would dominate, or
// farther apart than k_max_apart_s, where the velocity would be out of date.
inline Pose extrapolate(const Pose& before, double before_s, const Pose& last, double last_s,
                        double t_s) {
    const double dt_s = last_s - before_s;
    if (dt_s < k_min_apart_s || dt_s > k_max_apart_s) {
        return last;
    }
    const double steps = (t_s - last_s) / dt_s;
    const Vec3 turn =
        rotation_to_vector((last.rotation * before.rotation.conjugate()).normalized());
    return {last.position + steps * (last.position - before.position),
            (rotation_from_vector(steps * turn) * last.rotation).normalized()};
}

}  // namespace handhold

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "engine/math/math.hpp"

// A smooth closed path through given poses. Source: the periodic cubic spline with continuous
// second derivatives (de Boor 1978, "A Practical Guide to Splines", chapter IV), for positions and
// quaternion components; the quaternion is normalised on evaluation.
namespace handhold {

inline constexpr std::size_t k_max_path_keys = 16;

// A pose on the path and its rates of change. Made by make_pose_path.
struct PathKey {
    Pose pose;  // the quaternion is in the hemisphere of the previous key's
    Vec3 velocity_mps = Vec3::Zero();
    std::array<double, 4> quaternion_rate = {};  // x, y, z, w per second
};

// Plain data, usable as a component.
struct PosePath {
    // only the first `count` are used; evenly spaced over the period
    std::array<PathKey, k_max_path_keys> keys;
    std::uint32_t count = 0;
    double period_s = 1.0;
};

struct PosePathState {
    Pose pose;
    Vec3 velocity_mps = Vec3::Zero();
    Vec3 angular_velocity_radps = Vec3::Zero();
};

// Largest rotation between neighbouring poses. Beyond it, the interpolated quaternion's length
// differs too much from 1.
inline constexpr double k_max_path_turn_rad = 2.1;

// Path through poses[i] at time i * period_s / count. Returns to poses[0] after one period. Throws
// PreconditionError for fewer than 2 or more than k_max_path_keys poses, an invalid pose, a period
// <= 0, or neighbours (including last and first) that differ by more than k_max_path_turn_rad.
PosePath make_pose_path(std::span<const Pose> poses, double period_s);

// Closed form in time; t_s may be any value. Velocities are the derivatives of the pose.
// Precondition: `path` was made by make_pose_path.
PosePathState evaluate(const PosePath& path, double t_s);

}  // namespace handhold

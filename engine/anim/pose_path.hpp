#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "engine/math/math.hpp"

// A closed smooth way through given poses. Source: the periodic cubic spline with continuous second
// derivatives (de Boor 1978, "A Practical Guide to Splines", chapter IV), for positions and for the
// four numbers of the quaternion, which is made unit where it is read.
namespace handhold {

inline constexpr std::size_t k_max_path_keys = 16;

// A pose that the path passes through, and how fast. Made by make_pose_path.
struct PathKey {
    Pose pose;  // the quaternion's sign is that of the key before
    Vec3 velocity_mps = Vec3::Zero();
    std::array<double, 4> quaternion_rate = {};  // x, y, z, w a second
};

// Plain data: a component may hold one.
struct PosePath {
    std::array<PathKey, k_max_path_keys> keys;  // the first `count`, at equal steps of the period
    std::uint32_t count = 0;
    double period_s = 1.0;
};

struct PosePathState {
    Pose pose;
    Vec3 velocity_mps = Vec3::Zero();
    Vec3 angular_velocity_radps = Vec3::Zero();
};

// Rotations between neighbours are at most this far apart: beyond, the quaternion's way would leave
// the unit sphere too far.
inline constexpr double k_max_path_turn_rad = 2.1;

// The path that is at poses[i] at time i * period_s / count and at poses[0] again after a period.
// Throws PreconditionError for fewer than 2 or more than k_max_path_keys poses, a pose that is not
// valid, a period that is not above 0, or neighbours (the last and the first too) turned by more
// than k_max_path_turn_rad against each other.
PosePath make_pose_path(std::span<const Pose> poses, double period_s);

// In closed form of the time, which may be any: nothing accumulates. Velocities are the derivative
// of the pose. Precondition: made by make_pose_path.
PosePathState evaluate(const PosePath& path, double t_s);

}  // namespace handhold

#pragma once

#include <vector>

#include "engine/math/math.hpp"

// Ways that hands go.
namespace handhold::lab {

inline constexpr double k_hand_speed_mps = 1.5;
inline constexpr double k_twist_rad = 46.0 * k_pi / 180.0;

// To and fro between 0 and `way` at constant speed with instant reversals, beginning at `start`.
double to_and_fro(double t_s, double way, double speed, double start = 0.0);
// Round a closed polygon at constant speed; corners are instant.
Vec3 along_polygon(const std::vector<Vec3>& corners, double t_s, double speed_mps);
// A hand never rests: 1 mm at 10 Hz.
Vec3 tremor(double t_s);

}  // namespace handhold::lab

#pragma once

#include <vector>

#include "engine/math/math.hpp"

// Paths of hands over time.
namespace handhold::lab {

inline constexpr double k_hand_speed_mps = 1.5;
inline constexpr double k_twist_rad = 46.0 * k_pi / 180.0;

// Triangle wave between 0 and `travel` at constant speed with instant reversals, starting at
// `start`.
double triangle_wave(double t_s, double travel, double speed, double start = 0.0);
// Motion around a closed polygon at constant speed. The direction changes instantly at corners.
Vec3 along_polygon(const std::vector<Vec3>& corners, double t_s, double speed_mps);
// Hand tremor: 1 mm at 10 Hz.
Vec3 tremor(double t_s);

}  // namespace handhold::lab

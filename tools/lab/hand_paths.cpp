#include "tools/lab/hand_paths.hpp"

#include <cmath>

namespace handhold::lab {

double triangle_wave(double t_s, double travel, double speed, double start) {
    const double run = std::fmod(start + speed * t_s, 2.0 * travel);
    return run <= travel ? run : 2.0 * travel - run;
}

Vec3 along_polygon(const std::vector<Vec3>& corners, double t_s, double speed_mps) {
    double length = 0.0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        length += (corners[(i + 1) % corners.size()] - corners[i]).norm();
    }
    double rest = std::fmod(speed_mps * t_s, length);
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Vec3 side = corners[(i + 1) % corners.size()] - corners[i];
        if (rest <= side.norm()) {
            return corners[i] + side * (rest / side.norm());
        }
        rest -= side.norm();
    }
    return corners.front();
}

Vec3 tremor(double t_s) {
    const double wave = 1e-3 * std::sin(2.0 * k_pi * 10.0 * t_s);
    return wave * Vec3(1.0, 2.0, 2.0) / 3.0;
}

}  // namespace handhold::lab

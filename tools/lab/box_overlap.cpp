#include "tools/lab/box_overlap.hpp"

#include <algorithm>
#include <cmath>

namespace handhold::lab {

double box_overlap_m(const Pose& a, const Vec3& half_a_m, const Pose& b, const Vec3& half_b_m) {
    const Vec3 offset = b.position - a.position;
    const double reach_m = half_a_m.norm() + half_b_m.norm();
    if (offset.norm() >= reach_m) {
        return -1.0;
    }
    const Mat3 axes_a = a.rotation.toRotationMatrix();
    const Mat3 axes_b = b.rotation.toRotationMatrix();
    double least_m = reach_m;
    const auto test = [&](const Vec3& axis) {
        constexpr double k_parallel = 1e-6;
        const double length = axis.norm();
        if (length < k_parallel) {
            return;
        }
        const double extents = half_a_m.dot((axes_a.transpose() * axis).cwiseAbs()) +
                               half_b_m.dot((axes_b.transpose() * axis).cwiseAbs());
        least_m = std::min(least_m, (extents - std::abs(axis.dot(offset))) / length);
    };
    for (int i = 0; i < 3; ++i) {
        test(axes_a.col(i));
        test(axes_b.col(i));
        for (int j = 0; j < 3; ++j) {
            test(axes_a.col(i).cross(axes_b.col(j)));
        }
    }
    return least_m;
}

}  // namespace handhold::lab

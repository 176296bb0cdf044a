#include "engine/anim/two_bone_ik.hpp"

#include <algorithm>
#include <cmath>

namespace handhold {

Vec3 solve_two_bone_ik(const TwoBoneIk& ik) {
    const Vec3 reach = ik.tip - ik.root;
    const double distance = reach.norm();
    const double total = ik.upper_m + ik.lower_m;
    if (distance >= total) {
        return ik.root + reach * (ik.upper_m / total);
    }
    if (distance < 1e-9) {
        return ik.root + ik.upper_m * ik.bend;
    }
    // (u - l)(u + l) instead of u^2 - l^2: exact for bones of equal length at any distance.
    const double along = std::clamp(0.5 * (distance + (ik.upper_m - ik.lower_m) * total / distance),
                                    -ik.upper_m, ik.upper_m);
    const double aside = std::sqrt((ik.upper_m - along) * (ik.upper_m + along));
    return ik.root + reach * (along / distance) + ik.bend * aside;
}

}  // namespace handhold

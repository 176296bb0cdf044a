#pragma once

#include <algorithm>
#include <cmath>

#include "engine/math/math.hpp"

namespace handhold {

// Position of the joint between two bones in their plane, relative to the line from root to tip.
struct MiddleJoint {
    double along_m = 0.0;
    double aside_m = 0.0;  // >= 0
};

// Places the middle joint at `upper_m` from the root. If the tip, at `distance_m`, can be reached,
// the joint is at `lower_m` from the tip.
// - Tip too far: the joint is on the line to it, and both bones are stretched by the same factor.
// - Tip nearer than the difference of the bones: the joint is on the line, `upper_m` from the root.
// - Tip at the root: the joint is straight to the side.
//
// Lengths are > 0. Closed form (law of cosines), continuous in all arguments.
inline MiddleJoint middle_joint(double distance_m, double upper_m, double lower_m) {
    const double total = upper_m + lower_m;
    if (distance_m >= total) {
        return {distance_m * upper_m / total, 0.0};
    }
    if (distance_m < 1e-9) {
        return {0.0, upper_m};
    }
    // Computes (u - l)(u + l) instead of u^2 - l^2, which is exact for bones of equal length.
    const double along = std::clamp(0.5 * (distance_m + (upper_m - lower_m) * total / distance_m),
                                    -upper_m, upper_m);
    return {along, std::sqrt((upper_m - along) * (upper_m + along))};
}

struct TwoBoneIk {
    double upper_m = 0.0;  // > 0
    double lower_m = 0.0;  // > 0
    Vec3 root = Vec3::Zero();
    Vec3 tip = Vec3::Zero();
    // Unit, perpendicular to tip - root. The joint bends towards this side.
    Vec3 bend = Vec3::UnitY();
};

// Position of the middle joint.
Vec3 solve_two_bone_ik(const TwoBoneIk& ik);

}  // namespace handhold

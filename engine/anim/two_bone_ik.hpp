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

// Places the middle joint `upper_m` from the root and, if the tip at `distance_m` can be reached,
// `lower_m` from the tip. Too far: on the line, both bones stretched by the same factor. Nearer
// than the difference of the bones: on the line, `upper_m` from the root. Tip on the root: straight
// to the side. Lengths > 0. Law of cosines, closed form; continuous in all arguments.
inline MiddleJoint middle_joint(double distance_m, double upper_m, double lower_m) {
    const double total = upper_m + lower_m;
    if (distance_m >= total) {
        return {distance_m * upper_m / total, 0.0};
    }
    if (distance_m < 1e-9) {
        return {0.0, upper_m};
    }
    // (u - l)(u + l) instead of u^2 - l^2: exact for bones of equal length at any distance.
    const double along = std::clamp(0.5 * (distance_m + (upper_m - lower_m) * total / distance_m),
                                    -upper_m, upper_m);
    return {along, std::sqrt((upper_m - along) * (upper_m + along))};
}

struct TwoBoneIk {
    double upper_m = 0.0;  // > 0
    double lower_m = 0.0;  // > 0
    Vec3 root = Vec3::Zero();
    Vec3 tip = Vec3::Zero();
    // Unit, perpendicular to tip - root: side towards which the joint bends.
    Vec3 bend = Vec3::UnitY();
};

// Position of the middle joint.
Vec3 solve_two_bone_ik(const TwoBoneIk& ik);

}  // namespace handhold

#pragma once

#include <algorithm>
#include <cmath>

#include "engine/math/math.hpp"

namespace handhold {

// Where the joint between two bones lies in their plane: so far along the line from root to tip,
// and so far aside of it, metres.
struct MiddleJoint {
    double along_m = 0.0;
    double aside_m = 0.0;  // >= 0
};

// `upper_m` from the root, and `lower_m` from the tip where the tip, `distance_m` away, can be
// reached. Farther: on the line, with both bones stretched alike. Nearer than the bones'
// difference: on the line, `upper_m` from the root. On the root: straight to the side. Lengths > 0.
// Closed form (law of cosines); continuous in everything.
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
    Vec3 bend = Vec3::UnitY();  // unit and square to tip - root: the side to which the joint goes
};

// The middle joint in space.
Vec3 solve_two_bone_ik(const TwoBoneIk& ik);

}  // namespace handhold

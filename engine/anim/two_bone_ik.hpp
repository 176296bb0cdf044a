#pragma once

#include "engine/math/math.hpp"

namespace handhold {

struct TwoBoneIk {
    double upper_m = 0.0;  // > 0
    double lower_m = 0.0;  // > 0
    Vec3 root = Vec3::Zero();
    Vec3 tip = Vec3::Zero();
    Vec3 bend = Vec3::UnitY();  // unit and square to tip - root: the side to which the joint goes
};

// Where the joint between the bones lies: `upper_m` from the root, and `lower_m` from the tip where
// the tip can be reached. Farther: on the line, with both bones stretched alike. Nearer than the
// bones' difference: on the line, `upper_m` from the root. On the root: straight to the side.
// Closed form (law of cosines); continuous in everything.
Vec3 solve_two_bone_ik(const TwoBoneIk& ik);

}  // namespace handhold

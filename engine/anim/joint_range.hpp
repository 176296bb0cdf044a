#pragma once

#include "engine/math/math.hpp"

// Limits of joints that swing to rest at their ends.
namespace handhold {

// A link nears the end of its range by at most a share of what is left a tick. A stop within one
// tick would whip what hangs below, differently for each place in the tick at which it comes.
struct JointRange {
    double low_rad = 0.0;
    double high_rad = 0.0;
    double share = 1.0;  // (0, 1]
};

// Directions are in the frame of the link above; `angle_rad` is the angle of the last tick, then of
// this one.

// A cone about `rest`: the angle is that to it. All unit vectors.
Vec3 clamp_to_cone(const Vec3& towards, const Vec3& rest, const JointRange& range,
                   double& angle_rad);

// A hinge about X: the angle is that from -Y to +Z. The result lies square to X.
Vec3 clamp_to_hinge(const Vec3& towards, const JointRange& range, double& angle_rad);

}  // namespace handhold

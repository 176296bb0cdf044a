#pragma once

#include "engine/math/math.hpp"

// Joint limits that are approached gradually.
namespace handhold {

// In one tick, the angle covers at most `share` of its remaining distance to a limit. An abrupt
// stop would whip the links below, and the result would depend on the moment of the stop within the
// tick.
struct JointRange {
    double low_rad = 0.0;
    double high_rad = 0.0;
    double share = 1.0;  // (0, 1]
};

// Directions are in the parent link's frame. `angle_rad`: in, the last tick's angle; out, this
// tick's.

// Limits `towards` to a cone about `rest`. The angle is measured from `rest`. `towards`, `rest` and
// the result are unit vectors.
Vec3 clamp_to_cone(const Vec3& towards, const Vec3& rest, const JointRange& range,
                   double& angle_rad);

// Limits `towards` to a hinge about X. The angle is measured from -Y towards +Z. The result is
// perpendicular to X.
Vec3 clamp_to_hinge(const Vec3& towards, const JointRange& range, double& angle_rad);

}  // namespace handhold

#pragma once

#include "components/spine.hpp"
#include "engine/math/math.hpp"

// Limits the motion of a shown joint relative to the chest: its speed and the change of its
// velocity in a frame. A joint within its limits is not changed.
namespace handhold {

// In the player's metres.
struct JointLimits {
    double speed_mps = 0.0;
    double step_mps = 0.0;  // change of the velocity in a frame
    double acceleration_mps2 = 0.0;
    double catch_up_mps2 = 0.0;  // deceleration with which a lagging joint reaches its place
};

// How much the velocity may change in a frame. `scale`: PlayerOrigin::scale.
double step_mps_of(const JointLimits& limits, double scale, double dt_s);

Vec3 shortened_to(const Vec3& v, double most);

// Returns the joint's velocity in this frame if its earlier stages want it at `wanted_m`: the
// limited velocity, or one that leads to `wanted_m`.
Vec3 limited_mps(const Vec3& wanted_m, const JointLimits& limits, double scale, double dt_s,
                 const ShownJoint& joint);

// Returns where a joint with that velocity is shown: at `wanted_m` exactly, without rounding, if it
// gets there.
Vec3 shown_at(const Vec3& wanted_m, const Vec3& velocity_mps, double dt_s, const ShownJoint& joint);

}  // namespace handhold

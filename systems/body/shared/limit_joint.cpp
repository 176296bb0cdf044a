#include "systems/body/shared/limit_joint.hpp"

#include <algorithm>
#include <cmath>

namespace handhold {

double step_mps_of(const JointLimits& limits, double scale, double dt_s) {
    return scale * std::min(limits.step_mps, limits.acceleration_mps2 * dt_s);
}

Vec3 shortened_to(const Vec3& v, double most) {
    const double length = v.norm();
    return length > most ? Vec3(v * (most / length)) : v;
}

// A joint that lags by d and decelerates by b moves at sqrt(2 b d) towards its place. b leaves half
// of the change that a frame allows, so that the joint can also follow a place that moves.
Vec3 limited_mps(const Vec3& wanted_m, const JointLimits& limits, double scale, double dt_s,
                 const ShownJoint& joint) {
    const double step_mps = step_mps_of(limits, scale, dt_s);
    const Vec3 wanted_mps = (wanted_m - joint.wanted_m) / dt_s;
    const Vec3 lag_m = joint.wanted_m - joint.shown_m;
    const double slows_mps2 = std::min(scale * limits.catch_up_mps2, 0.5 * step_mps / dt_s);
    const double catch_up_mps = std::sqrt(2.0 * slows_mps2 * lag_m.norm());
    const Vec3 free_mps = wanted_mps + shortened_to(lag_m / dt_s, catch_up_mps);
    const Vec3 change_mps = shortened_to(free_mps, scale * limits.speed_mps) - joint.velocity_mps;
    return joint.velocity_mps + shortened_to(change_mps, step_mps);
}

Vec3 shown_at(const Vec3& wanted_m, const Vec3& velocity_mps, double dt_s,
              const ShownJoint& joint) {
    constexpr double k_same_m = 1e-9;
    const Vec3 shown_m = joint.shown_m + dt_s * velocity_mps;
    return (shown_m - wanted_m).norm() < k_same_m ? wanted_m : shown_m;
}

}  // namespace handhold

#include "systems/body/shared/hang_body.hpp"

#include <cmath>

namespace handhold {
namespace {

// Angle by which a trunk turns whose pull is strong, at `angle_rad` from the chest's +Y.
double whole_lean_rad(double angle_rad) {
    return angle_rad * (1.0 - smooth_step(angle_rad, k_whole_lean_rad, k_no_lean_rad));
}

// -Y turned by a rotation about a horizontal axis. `turn`: rotation vector with y = 0.
Vec3 turned_down(const Vec3& turn) {
    const double angle = std::sqrt(turn.x() * turn.x() + turn.z() * turn.z());
    if (angle < 1e-12) {
        return -Vec3::UnitY();
    }
    double sine = 0.0;
    double cosine = 1.0;
    sin_cos(angle, sine, cosine);
    const double by = sine / angle;
    return {by * turn.z(), -cosine, -by * turn.x()};
}

}  // namespace

void follow_pull(const Vec3& hands, double tick_s, const SpineTuning& tuning, BodyPull& pull) {
    const Vec3 strength = tuning.hang * hands;
    const Vec3 wanted = strength * (1.0 / std::sqrt(1.0 + strength.squaredNorm()));
    // A critically damped spring of rate 2 / lag, integrated implicitly: its mean delay is the lag.
    const double lag_s = tuning.hang_lag_s;
    const double slowed_s = lag_s + 2.0 * tick_s;
    pull.rate_per_s = (lag_s * lag_s * pull.rate_per_s + 4.0 * tick_s * (wanted - pull.now)) *
                      (1.0 / (slowed_s * slowed_s));
    pull.before = pull.now;
    pull.now += tick_s * pull.rate_per_s;
}

TrunkLean lean_of(const Vec3& pull_cs) {
    TrunkLean lean;
    lean.rest_above.fill(-Vec3::UnitY());
    const double strength = pull_cs.norm();
    const double aside = std::sqrt(pull_cs.x() * pull_cs.x() + pull_cs.z() * pull_cs.z());
    if (!(aside > 1e-9)) {
        return lean;
    }
    // The trunk turns from -Y towards -pull, about their common normal.
    const Vec3 axis = Vec3(pull_cs.z(), 0.0, -pull_cs.x()) * (1.0 / aside);
    const Vec3 quarter = 0.25 * strength * whole_lean_rad(arc_tangent2(aside, pull_cs.y())) * axis;
    lean.chest_rad = quarter.x();
    lean.rest_above[0] = turned_down({quarter.x(), 0.0, 2.0 * quarter.z()});
    lean.rest_above[1] = turned_down(quarter);
    lean.rest_above[2] = turned_down(quarter);
    return lean;
}

}  // namespace handhold

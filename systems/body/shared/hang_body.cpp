#include "systems/body/shared/hang_body.hpp"

#include <algorithm>
#include <cmath>

#include "engine/anim/deflect_outward.hpp"

namespace handhold {
namespace {

// Angle by which a very strong pull at `angle_rad` from the chest's +Y turns the trunk.
double whole_lean_rad(double angle_rad) {
    return angle_rad * (1.0 - smooth_step(angle_rad, k_whole_lean_rad, k_no_lean_rad));
}

// Minimum of x and `ceiling`. A parabola replaces the corner, `width` to either side, so that the
// slope is continuous.
double smooth_min(double x, double ceiling, double width) {
    const double under = ceiling + width - x;
    if (under <= 0.0) {
        return ceiling;
    }
    return under >= 2.0 * width ? x : ceiling - under * under / (4.0 * width);
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

TrunkLean lean_of(const Vec3& pull_cs, const Vec3& upright_rad) {
    // Shares of upright_rad that the chest and the links take. The chest takes no turn about Z,
    // because the line of the shoulders must not tilt.
    constexpr double k_chest = 0.9;
    constexpr double k_first = 0.08;
    constexpr double k_second = 1.0 - k_chest - k_first;
    TrunkLean lean;
    lean.rest_above.fill(-Vec3::UnitY());
    const double strength = pull_cs.norm();
    const double aside = std::sqrt(pull_cs.x() * pull_cs.x() + pull_cs.z() * pull_cs.z());
    Vec3 quarter = Vec3::Zero();
    if (aside > 1e-9) {
        // The trunk turns from -Y towards -pull, about their common normal.
        const Vec3 axis = Vec3(pull_cs.z(), 0.0, -pull_cs.x()) * (1.0 / aside);
        quarter = 0.25 * strength * whole_lean_rad(arc_tangent2(aside, pull_cs.y())) * axis;
    }
    const Vec3 upright = (1.0 - strength) * upright_rad;
    if (quarter == Vec3::Zero() && upright == Vec3::Zero()) {
        return lean;
    }
    lean.chest_rad = quarter.x() + k_chest * upright.x();
    lean.rest_above[0] = turned_down({quarter.x() + k_first * upright.x(), 0.0,
                                      2.0 * quarter.z() + (k_chest + k_first) * upright.z()});
    lean.rest_above[1] = turned_down(quarter + k_second * upright);
    lean.rest_above[2] = turned_down(quarter);
    return lean;
}

Vec3 upright_turn(const Vec3& up_cs, double lying) {
    // Largest bend of a neck. A lean of the chest beyond it is the trunk's. The corner is rounded
    // over k_width_rad to either side.
    constexpr double k_neck_rad = 0.7;
    constexpr double k_width_rad = 0.2;
    const double aside = std::sqrt(up_cs.x() * up_cs.x() + up_cs.z() * up_cs.z());
    if (!(aside > 1e-9) || lying >= 1.0) {
        return Vec3::Zero();
    }
    const double angle = arc_tangent2(aside, up_cs.y());
    // Below a chest that is upside down there is no upright trunk.
    const double fade = 1.0 - smooth_step(angle, 1.2, 2.6);
    const double turn = (1.0 - lying) * fade * smooth_min(angle, k_neck_rad, k_width_rad);
    return Vec3(up_cs.z(), 0.0, -up_cs.x()) * (turn / aside);
}

Vec3 free_body(const Quat& chest_ps, double lying) {
    const Vec3 up_cs = chest_ps.conjugate() * Vec3::UnitY();
    return chest_ps * turned_down(upright_turn(up_cs, lying));
}

Vec3 surface_pull(const BodyContact& contact, const Vec3& free_ps, const Vec3& back_ps,
                  double length_m) {
    constexpr double k_back = 0.6;
    constexpr double k_strength = 3.0;  // length in arm lengths; more than two hands pull
    // Share of the length behind the surface from which the pull is full.
    constexpr double k_full = 0.15;
    if (!contact.touches) {
        return Vec3::Zero();
    }
    const double least = std::min(contact.surface_m / length_m, 0.0);
    const double behind = least - contact.normal_ps.dot(free_ps);
    if (behind <= 0.0) {
        return Vec3::Zero();
    }
    // A body square to the surface swings backwards.
    const Vec3 aside = (free_ps + k_back * back_ps).normalized();
    const Vec3 along = deflect_outward(aside, contact.normal_ps, least, 2.0);
    return (-k_strength * smooth_step(behind, 0.0, k_full)) * along;
}

}  // namespace handhold

#include "systems/body/shared/level_direction.hpp"

#include <algorithm>
#include <cmath>

#include "engine/math/scalar_rotation.hpp"

namespace handhold {
namespace {

constexpr double k_near_level_cosine = 0.95;  // share_of_line is used for larger cosines

Vec3 level_unit(const Vec3& v) {
    const double by = 1.0 / std::sqrt(v.x() * v.x() + v.z() * v.z());
    return {v.x() * by, 0.0, v.z() * by};
}

}  // namespace

Vec3 turned_left(const Vec3& v, double cosine, double sine) {
    return level_unit({cosine * v.x() + sine * v.z(), 0.0, cosine * v.z() - sine * v.x()});
}

Quat level_rotation(const Vec3& facing) {
    // Uses half-angle formulas, which need no trigonometry.
    const double cosine = -facing.z();
    const double sine = -facing.x();
    if (cosine > -0.5) {
        return unit_quat(1.0 + cosine, 0.0, sine, 0.0);
    }
    return unit_quat(std::abs(sine), 0.0, std::copysign(1.0 - cosine, sine), 0.0);
}

Vec3 level_look(const Vec3& ahead, const Vec3& up) {
    // Blends from 45 degrees of pitch to 90; ahead.y() is the sine of the pitch.
    const double pitch = ahead.y();
    const double blend = smooth_step(std::abs(pitch), k_level_look_sine, 1.0);
    const Vec3 look = (1.0 - blend) * ahead + (pitch > 0.0 ? -blend : blend) * up;
    const double length = std::sqrt(look.x() * look.x() + look.z() * look.z());
    return length > 1e-9 ? Vec3(look.x() / length, 0.0, look.z() / length) : Vec3(-Vec3::UnitZ());
}

Vec3 follow_look(const Vec3& look_ps, const Vec3& now_ps, double share) {
    const double cosine_now = look_ps.dot(now_ps);
    if (cosine_now > k_near_level_cosine) {
        return level_unit(look_ps + share_of_line(share, cosine_now) * (now_ps - look_ps));
    }
    const double angle = arc_tangent2(sine_between(look_ps, now_ps), cosine_now);
    double sine = 0.0;
    double cosine = 1.0;
    sin_cos(angle * share, sine, cosine);
    return turned_left(look_ps, cosine, sine);
}

Vec3 turn_at_most(const Vec3& facing_ps, const Vec3& now_ps, double most_rad) {
    const double sine_now = sine_between(facing_ps, now_ps);
    const double cosine_now = facing_ps.dot(now_ps);
    // In most frames the angle is below the limit. sin x > 0.9 x for x < 0.7 shows this without
    // trigonometry.
    if (cosine_now > 0.75 && std::abs(sine_now) <= 0.9 * most_rad) {
        return now_ps;
    }
    const double angle = arc_tangent2(sine_now, cosine_now);
    double sine = 0.0;
    double cosine = 1.0;
    sin_cos(std::clamp(angle, -most_rad, most_rad), sine, cosine);
    return turned_left(facing_ps, cosine, sine);
}

}  // namespace handhold

#pragma once

#include "engine/math/math.hpp"

// Level directions: horizontal unit vectors, in play space. To save time, follow_look and
// turn_at_most call no trigonometric function if the angle is small.
namespace handhold {

// A maximum angle of at most half a turn, given by its sine and cosine.
struct TurnLimit {
    double sine = 0.0;
    double cosine = 1.0;
};

// Sine of the angle from `a` to `b`, both level; positive if `b` is to the left of `a`.
inline double sine_between(const Vec3& a, const Vec3& b) { return a.z() * b.x() - a.x() * b.z(); }

// to_facing converts a play-space vector to axes whose -Z is the level direction `facing`;
// from_facing converts back.
inline Vec3 to_facing(const Vec3& facing, const Vec3& v) {
    return {facing.x() * v.z() - facing.z() * v.x(), v.y(),
            -(facing.x() * v.x() + facing.z() * v.z())};
}
inline Vec3 from_facing(const Vec3& facing, const Vec3& v) {
    return {-(facing.z() * v.x() + facing.x() * v.z()), v.y(),
            facing.x() * v.x() - facing.z() * v.z()};
}

// Turns a level direction to the left by an angle given as cosine and sine.
Vec3 turned_left(const Vec3& v, double cosine, double sine);

// Rotation about +Y that turns -Z to the level direction.
Quat level_rotation(const Vec3& facing);

inline constexpr double k_level_look_sine = 0.70710678118654752;  // sine of an eighth of a turn

// Level look direction of a head, from its forward axis `ahead` and its up axis. Beyond a pitch
// with the sine k_level_look_sine the up axis blends in (negated if the head looks up), because
// `ahead` becomes vertical.
Vec3 level_look(const Vec3& ahead, const Vec3& up);

// Gain dt / (dt + lag) of an implicit low-pass filter. The output lags a steady motion by lag_s at
// any frame rate.
inline double follow_share(double dt_s, double lag_s) { return dt_s / (dt_s + lag_s); }

// Turns the level direction `look_ps` towards `now_ps` by `share` of the angle.
Vec3 follow_look(const Vec3& look_ps, const Vec3& now_ps, double share);

// Turns the level direction `facing_ps` towards `now_ps` by at most `most_rad`.
Vec3 turn_at_most(const Vec3& facing_ps, const Vec3& now_ps, double most_rad);

}  // namespace handhold

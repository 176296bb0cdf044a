#pragma once

// Arithmetic of hh_vec3, hh_quat and hh_pose for C++20 hosts that have no vector types of their
// own. Header only, except sine and arc tangent, which are the library's. Every operation rounds
// exactly as the library's own mathematics does, if the host is compiled without fused multiply-add
// (-ffp-contract=off). Include it beside handhold.hpp; nothing else includes it.

#include <cmath>

#include <handhold/base.h>

constexpr bool operator==(hh_vec3 a, hh_vec3 b) { return a.x == b.x && a.y == b.y && a.z == b.z; }
constexpr hh_vec3 operator+(hh_vec3 a, hh_vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
constexpr hh_vec3 operator-(hh_vec3 a, hh_vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
constexpr hh_vec3 operator-(hh_vec3 v) { return {-v.x, -v.y, -v.z}; }
constexpr hh_vec3 operator*(double s, hh_vec3 v) { return {s * v.x, s * v.y, s * v.z}; }
constexpr hh_vec3 operator*(hh_vec3 v, double s) { return s * v; }
constexpr hh_vec3 operator/(hh_vec3 v, double s) { return {v.x / s, v.y / s, v.z / s}; }
constexpr hh_vec3& operator+=(hh_vec3& a, hh_vec3 b) { return a = a + b; }
constexpr hh_vec3& operator-=(hh_vec3& a, hh_vec3 b) { return a = a - b; }
constexpr hh_vec3& operator*=(hh_vec3& v, double s) { return v = s * v; }
constexpr bool operator==(hh_quat a, hh_quat b) {
    return a.x == b.x && a.y == b.y && a.z == b.z && a.w == b.w;
}

namespace hh {

inline constexpr hh_vec3 k_x{1.0, 0.0, 0.0};
inline constexpr hh_vec3 k_y{0.0, 1.0, 0.0};
inline constexpr hh_vec3 k_z{0.0, 0.0, 1.0};

constexpr double dot(hh_vec3 a, hh_vec3 b) { return a.x * b.x + (a.y * b.y + a.z * b.z); }
constexpr hh_vec3 cross(hh_vec3 a, hh_vec3 b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double length(hh_vec3 v) { return std::sqrt(dot(v, v)); }
// Zero stays zero.
inline hh_vec3 normalized(hh_vec3 v) {
    const double squared = dot(v, v);
    return squared > 0.0 ? v / std::sqrt(squared) : v;
}

// Quaternions. The functions below take unit quaternions, except normalized().
constexpr hh_quat conjugate(hh_quat q) { return {-q.x, -q.y, -q.z, q.w}; }
inline hh_quat normalized(hh_quat q) {
    const double squared = (q.x * q.x + q.y * q.y) + (q.z * q.z + q.w * q.w);
    if (!(squared > 0.0)) {
        return q;
    }
    const double length = std::sqrt(squared);
    return {q.x / length, q.y / length, q.z / length, q.w / length};
}

}  // namespace hh

// a * b rotates by b, then by a. Not normalised.
constexpr hh_quat operator*(hh_quat a, hh_quat b) {
    return {a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
            a.w * b.y + a.y * b.w + a.z * b.x - a.x * b.z,
            a.w * b.z + a.z * b.w + a.x * b.y - a.y * b.x,
            a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}
// The vector, rotated.
constexpr hh_vec3 operator*(hh_quat q, hh_vec3 v) {
    const hh_vec3 axis{q.x, q.y, q.z};
    const hh_vec3 half = hh::cross(axis, v);
    const hh_vec3 twice = half + half;
    return v + q.w * twice + hh::cross(axis, twice);
}
// a * b transforms by b, then by a.
inline hh_pose operator*(const hh_pose& a, const hh_pose& b) {
    return {a.position + a.rotation * b.position, hh::normalized(a.rotation * b.rotation)};
}

namespace hh {

constexpr hh_vec3 transform_point(const hh_pose& pose, hh_vec3 point) {
    return pose.position + pose.rotation * point;
}
constexpr hh_vec3 inverse_transform_point(const hh_pose& pose, hh_vec3 point) {
    return conjugate(pose.rotation) * (point - pose.position);
}
constexpr hh_pose inverse(const hh_pose& pose) {
    const hh_quat rotation = conjugate(pose.rotation);
    return {-(rotation * pose.position), rotation};
}
// True if all numbers are finite and the rotation's length is within 0.001 of one.
inline bool is_valid(const hh_pose& pose) {
    const hh_quat& q = pose.rotation;
    const double squared = (q.x * q.x + q.y * q.y) + (q.z * q.z + q.w * q.w);
    return std::isfinite(pose.position.x) && std::isfinite(pose.position.y) &&
           std::isfinite(pose.position.z) && std::isfinite(squared) &&
           std::abs(squared - 1.0) < 2e-3;
}

// Equal on every machine, unlike std::sin.
inline double sine(double angle_rad) {
    double sine = 0.0;
    hh_sin_cos(angle_rad, &sine, nullptr);
    return sine;
}
// Rotation by angle_rad about a unit axis.
inline hh_quat rotation_about(hh_vec3 axis, double angle_rad) {
    double s = 0.0;
    double c = 1.0;
    hh_sin_cos(0.5 * angle_rad, &s, &c);
    const hh_vec3 v = s * axis;
    const double inverse_length = 1.0 / std::sqrt(c * c + v.x * v.x + (v.y * v.y + v.z * v.z));
    return {v.x * inverse_length, v.y * inverse_length, v.z * inverse_length, c * inverse_length};
}
// Rotation about vector_rad by its length. rotation_to_vector returns the shortest such vector.
inline hh_quat rotation_from_vector(hh_vec3 vector_rad) {
    const double angle = length(vector_rad);
    if (angle < 1e-12) {
        return normalized(hh_quat{0.5 * vector_rad.x, 0.5 * vector_rad.y, 0.5 * vector_rad.z, 1.0});
    }
    return rotation_about(vector_rad / angle, angle);
}
inline hh_vec3 rotation_to_vector(hh_quat rotation) {
    const double sign = rotation.w < 0.0 ? -1.0 : 1.0;
    const hh_vec3 axis = sign * hh_vec3{rotation.x, rotation.y, rotation.z};
    const double sine = length(axis);
    if (sine < 1e-12) {
        return 2.0 * axis;
    }
    return axis * (2.0 * hh_atan2(sine, sign * rotation.w) / sine);
}
// Rotation that maps the coordinate axes onto x, y and z, which are orthonormal and right-handed.
// Not normalised.
inline hh_quat rotation_from_axes(hh_vec3 x, hh_vec3 y, hh_vec3 z) {
    const double trace = x.x + (y.y + z.z);
    if (trace > 0.0) {
        const double root = std::sqrt(trace + 1.0);
        const double scale = 0.5 / root;
        return {(y.z - z.y) * scale, (z.x - x.z) * scale, (x.y - y.x) * scale, 0.5 * root};
    }
    if (x.x >= y.y && x.x >= z.z) {
        const double root = std::sqrt(x.x - y.y - z.z + 1.0);
        const double scale = 0.5 / root;
        return {0.5 * root, (x.y + y.x) * scale, (x.z + z.x) * scale, (y.z - z.y) * scale};
    }
    if (y.y >= z.z) {
        const double root = std::sqrt(y.y - z.z - x.x + 1.0);
        const double scale = 0.5 / root;
        return {(y.x + x.y) * scale, 0.5 * root, (y.z + z.y) * scale, (z.x - x.z) * scale};
    }
    const double root = std::sqrt(z.z - x.x - y.y + 1.0);
    const double scale = 0.5 / root;
    return {(z.x + x.z) * scale, (z.y + y.z) * scale, 0.5 * root, (x.y - y.x) * scale};
}
// Shortest rotation from unit vector `from` to unit vector `to`; some half turn if they are
// opposite.
inline hh_quat rotation_between(hh_vec3 from, hh_vec3 to) {
    const double cosine = dot(from, to);
    hh_vec3 axis = cross(from, to);
    if (cosine > -0.5) {
        const double w = 1.0 + cosine;
        const double inverse_length =
            1.0 / std::sqrt(w * w + axis.x * axis.x + (axis.y * axis.y + axis.z * axis.z));
        return {axis.x * inverse_length, axis.y * inverse_length, axis.z * inverse_length,
                w * inverse_length};
    }
    if (length(axis) < 1e-14) {
        axis = cross(from, std::abs(from.x) < 0.7 ? k_x : k_y);
    }
    axis = normalized(axis);
    axis = normalized(axis - from * dot(from, axis));
    const hh_vec3 v = axis * length(from - to);
    return normalized(hh_quat{v.x, v.y, v.z, length(from + to)});
}
// Rotation with -Z along `forward` and +Y as near to `up` as possible. Both have any length but 0.
// If they are parallel, the roll is arbitrary.
inline hh_quat look_rotation(hh_vec3 forward, hh_vec3 up) {
    constexpr double k_in_line = 1e-6;
    const hh_vec3 back = -normalized(forward);
    const hh_vec3 across = cross(up, back);
    const hh_vec3 other = std::abs(back.x) + std::abs(back.y) > 1e-6 * std::abs(back.z)
                              ? hh_vec3{-back.y, back.x, 0.0}
                              : hh_vec3{0.0, -back.z, back.y};
    const hh_vec3 right = normalized(length(across) <= k_in_line * length(up) ? other : across);
    return normalized(rotation_from_axes(right, cross(back, right), back));
}
// Along the shorter arc at constant speed, t in [0, 1]; positions linearly.
inline hh_pose interpolate(const hh_pose& a, const hh_pose& b, double t) {
    const hh_vec3 turn = rotation_to_vector(conjugate(a.rotation) * b.rotation);
    return {a.position + t * (b.position - a.position),
            normalized(a.rotation * rotation_from_vector(t * turn))};
}

}  // namespace hh

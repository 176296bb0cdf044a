#pragma once

#include <numbers>

#include <Eigen/Core>
#include <Eigen/Geometry>

// The CMake target sets this macro for the library and its hosts. With vectorisation, the order of
// Eigen's sums depends on the instruction set, and Eigen's types have another memory layout.
#ifndef EIGEN_DONT_VECTORIZE
#error "compile with EIGEN_DONT_VECTORIZE, as handhold::runtime does"
#endif

// The only file of the engine that includes Eigen. Right-handed, +Y up, -Z forward, +X right;
// metres, seconds, radians. Never use `auto` for an Eigen expression: it would hold references to
// temporaries.
namespace handhold {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Quat = Eigen::Quaterniond;

inline constexpr double k_pi = std::numbers::pi;
inline constexpr double k_half_pi = 0.5 * k_pi;
inline constexpr double k_two_pi = 2.0 * k_pi;
inline constexpr double k_degree = k_pi / 180.0;  // radians per degree
inline constexpr double k_mm_per_m = 1000.0;

// A rigid transform: rotates, then translates. `a * b` applies b first.
struct Pose {
    Vec3 position = Vec3::Zero();
    Quat rotation = Quat::Identity();  // unit
};

inline Vec3 transform_point(const Pose& pose, const Vec3& point) {
    return pose.position + pose.rotation * point;
}
inline Vec3 inverse_transform_point(const Pose& pose, const Vec3& point) {
    return pose.rotation.conjugate() * (point - pose.position);
}
inline Pose operator*(const Pose& a, const Pose& b) {
    return {transform_point(a, b.position), (a.rotation * b.rotation).normalized()};
}
inline Pose inverse(const Pose& pose) {
    const Quat rotation = pose.rotation.conjugate();
    return {-(rotation * pose.position), rotation};
}

// x -> linear * x + translation. Unlike Pose, it may scale, shear and mirror.
struct Affine {
    Mat3 linear = Mat3::Identity();
    Vec3 translation = Vec3::Zero();
};
inline Affine to_affine(const Pose& pose) {
    return {pose.rotation.toRotationMatrix(), pose.position};
}
inline Vec3 transform_point(const Affine& affine, const Vec3& point) {
    return affine.linear * point + affine.translation;
}
// Normal of a surface transformed by `linear`, not normalised. Uses the cofactor matrix: the normal
// stays perpendicular under any scale and outward under mirroring.
Vec3 transform_normal(const Mat3& linear, const Vec3& normal);
inline Affine operator*(const Affine& a, const Affine& b) {
    return {a.linear * b.linear, transform_point(a, b.translation)};
}

// Cross-product matrix: cross_matrix(v) * u == v.cross(u).
inline Mat3 cross_matrix(const Vec3& v) {
    Mat3 m;
    m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
    return m;
}

inline bool is_finite(const Vec3& v) { return v.allFinite(); }
// True if all components are finite and the rotation's length is within 1e-3 of one.
bool is_valid(const Pose& pose);

// Deterministic sine and cosine: libm chooses its code by CPU, so its last bits differ between
// machines, and these values reach state. Absolute error below 1e-15 for |angle| <= 1e3 and below
// 1e-14 up to 1e6. For larger angles, infinities and NaN returns 0 and 1. -0.0 gives 0.0.
void sin_cos(double angle_rad, double& sine, double& cosine);
inline double sine(double angle_rad) {
    double s = 0.0;
    double c = 1.0;
    sin_cos(angle_rad, s, c);
    return s;
}
// Angle of (x, y) from +X towards +Y in (-pi, pi], error below 1e-15. Arguments may be tiny, huge
// or infinite; -0.0 counts as 0.0. Returns 0 for (0, 0) and NaN. Deterministic, like sin_cos.
double arc_tangent2(double y, double x);

// Natural logarithm of a positive finite number, relative error below 1e-15. 0 and negative numbers
// give -infinity, NaN gives NaN. Deterministic, like sin_cos.
double natural_logarithm(double x);
// Cube root of a number >= 0, relative error below 1e-15. Returns infinity and NaN unchanged;
// negative numbers give NaN. Deterministic, like sin_cos.
double cube_root(double x);

// rotation_from_vector: unit quaternion of the rotation about `vector_rad`, by its length.
// rotation_to_vector is the inverse and returns the shortest vector, with a length in [0, pi].
Quat rotation_from_vector(const Vec3& vector_rad);
Vec3 rotation_to_vector(const Quat& rotation);
// Rotation by angle_rad about the unit vector `axis`.
Quat rotation_about(const Vec3& axis, double angle_rad);
// Shortest rotation from unit vector `from` to unit vector `to`; an arbitrary half turn if they are
// opposite.
Quat rotation_between(const Vec3& from, const Vec3& to);

// Rotation with -Z along `forward` and +Y as near to `up` as possible. `forward` and `up` may have
// any length but 0. If they are parallel, the roll is arbitrary.
Quat look_rotation(const Vec3& forward, const Vec3& up);

// Interpolates two rotations along the shorter arc at constant speed, t in [0, 1].
Quat interpolate(const Quat& a, const Quat& b, double t);
// Interpolates two poses, t in [0, 1]: positions linearly, rotations along the shorter arc at
// constant speed.
Pose interpolate(const Pose& a, const Pose& b, double t);

// 0 for x <= from, 1 for x >= to; in between 3t^2 - 2t^3, t = (x - from) / (to - from).
// Precondition: from < to.
double smooth_step(double x, double from, double to);

}  // namespace handhold

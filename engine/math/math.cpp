// Sine and cosine: see trigonometry_series.hpp. The arc tangent uses a table, the addition theorem
// and a series.
#include "engine/math/math.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/math/scalar_rotation.hpp"
#include "engine/math/trigonometry_series.hpp"

namespace handhold {
namespace {

// arctan on [0, 1]. Starts at the nearest tabulated sixteenth. The remainder is below 1/32, where
// five terms of the series reach full precision.
double arc_tangent_unit(double x) {
    constexpr double k_steps = 16.0;
    constexpr double k_table[] = {
        0.0,
        0.06241880999595735,
        0.12435499454676144,
        0.18534794999569476,
        0.24497866312686414,
        0.30288486837497142,
        0.35877067027057225,
        0.41241044159738732,
        0.46364760900080609,
        0.51238946031073773,
        0.55859931534356244,
        0.60228734613496415,
        0.64350110879328437,
        0.68231655487474807,
        0.71882999962162453,
        0.75315128096219441,
        0.78539816339744828,
    };
    // Truncation rounds x to the nearest step, because x >= 0.
    const double half_way_on = x * k_steps + 0.5;
    const int step = static_cast<int>(half_way_on);
    const double from = step * (1.0 / k_steps);
    const double rest = (x - from) / (1.0 + x * from);
    const double z = rest * rest;
    double sum = -9.0909090909090912e-02;  // 1/11
    sum = sum * z + 1.1111111111111110e-01;
    sum = sum * z - 1.4285714285714285e-01;
    sum = sum * z + 2.0000000000000001e-01;
    sum = sum * z - 3.3333333333333331e-01;
    return k_table[step] + (rest + rest * z * sum);
}

}  // namespace

Vec3 transform_normal(const Mat3& linear, const Vec3& normal) {
    const Vec3 x = linear.col(0);
    const Vec3 y = linear.col(1);
    const Vec3 z = linear.col(2);
    const Vec3 turned = y.cross(z) * normal.x() + z.cross(x) * normal.y() + x.cross(y) * normal.z();
    return x.dot(y.cross(z)) < 0.0 ? Vec3(-turned) : turned;
}

bool is_valid(const Pose& pose) {
    const double norm = pose.rotation.squaredNorm();
    return pose.position.allFinite() && std::isfinite(norm) && std::abs(norm - 1.0) < 2e-3;
}

void sin_cos(double angle_rad, double& sine, double& cosine) {
    if (!(std::abs(angle_rad) < k_largest_reduced_rad)) {  // true for NaN, too
        sine = 0.0;
        cosine = 1.0;
        return;
    }
    const double quarters = (angle_rad * k_two_over_pi + k_last_place_one) - k_last_place_one;
    const double x = reduced_angle(angle_rad, quarters);
    const double s = sine_series(x);
    const double c = cosine_series(x);
    switch (static_cast<long>(quarters) & 3) {
        case 0:
            sine = s, cosine = c;
            break;
        case 1:
            sine = c, cosine = -s;
            break;
        case 2:
            sine = -s, cosine = -c;
            break;
        default:
            sine = -c, cosine = s;
            break;
    }
}

double arc_tangent2(double y, double x) {
    const double ax = std::abs(x);
    const double ay = std::abs(y);
    if (!(ax + ay > 0.0)) {  // both are 0, or one is NaN
        return 0.0;
    }
    // The angle for equal magnitudes. Two infinities count as equal, because they have no quotient.
    double angle = 0.25 * k_pi;
    if (ay < ax) {
        angle = arc_tangent_unit(ay / ax);
    } else if (ay > ax) {
        angle = 0.5 * k_pi - arc_tangent_unit(ax / ay);
    }
    if (x < 0.0) {
        angle = k_pi - angle;
    }
    return y < 0.0 ? -angle : angle;
}

double natural_logarithm(double x) {
    if (!(x > 0.0) || std::isinf(x)) {
        return x <= 0.0 ? -std::numeric_limits<double>::infinity() : x;
    }
    int exponent = 0;
    double mantissa = std::frexp(x, &exponent);  // range [0.5, 1)
    constexpr double k_half_root = 0.70710678118654757;
    if (mantissa < k_half_root) {
        mantissa *= 2.0;
        --exponent;
    }
    // ln m = 2 artanh s = 2 (s + s^3 / 3 + ...), s = (m - 1) / (m + 1), |s| < 0.172.
    const double s = (mantissa - 1.0) / (mantissa + 1.0);
    const double z = s * s;
    double sum = 0.0;
    for (int power = 21; power >= 3; power -= 2) {
        sum = (sum + 1.0 / power) * z;
    }
    // ln 2 = k_ln2_high + k_ln2_low. Integer multiples of k_ln2_high up to 2^11 are exact.
    constexpr double k_ln2_high = 6.93147180369123816490e-01;
    constexpr double k_ln2_low = 1.90821492927058770002e-10;
    return exponent * k_ln2_high + (exponent * k_ln2_low + 2.0 * (s + s * sum));
}

double cube_root(double x) {
    if (!(x > 0.0) || std::isinf(x)) {
        return x < 0.0 ? std::numeric_limits<double>::quiet_NaN() : x;
    }
    int exponent = 0;
    double mantissa = std::frexp(x, &exponent);  // range [0.5, 1)
    while (exponent % 3 != 0) {
        mantissa *= 0.5;
        ++exponent;
    }
    // Newton's method. The start value is a line close to the root on [1/8, 1). Each step doubles
    // the number of correct digits.
    double root = 0.46 + 0.57 * mantissa;
    for (int step = 0; step < 6; ++step) {
        root -= (root - mantissa / (root * root)) * (1.0 / 3.0);
    }
    return std::ldexp(root, exponent / 3);
}

Quat rotation_from_vector(const Vec3& vector_rad) {
    const double angle = vector_rad.norm();
    if (angle < 1e-12) {
        return Quat(1.0, 0.5 * vector_rad.x(), 0.5 * vector_rad.y(), 0.5 * vector_rad.z())
            .normalized();
    }
    return rotation_about(vector_rad / angle, angle);
}

Vec3 rotation_to_vector(const Quat& rotation) {
    // A quaternion and its negative are the same rotation. Uses the one with the shorter vector.
    const double sign = rotation.w() < 0.0 ? -1.0 : 1.0;
    const Vec3 axis = sign * rotation.vec();
    const double sine = axis.norm();
    if (sine < 1e-12) {
        return 2.0 * axis;
    }
    return axis * (2.0 * arc_tangent2(sine, sign * rotation.w()) / sine);
}

Quat rotation_about(const Vec3& axis, double angle_rad) {
    double sine = 0.0;
    double cosine = 1.0;
    sin_cos(0.5 * angle_rad, sine, cosine);
    return unit_quat(cosine, sine * axis.x(), sine * axis.y(), sine * axis.z());
}

Quat look_rotation(const Vec3& forward, const Vec3& up) {
    constexpr double k_in_line = 1e-6;
    const Vec3 back = -forward.normalized();
    const Vec3 across = up.cross(back);
    const bool is_in_line = across.norm() <= k_in_line * up.norm();
    const Vec3 right = is_in_line ? Vec3(back.unitOrthogonal()) : Vec3(across.normalized());
    Mat3 axes;
    axes.col(0) = right;
    axes.col(1) = back.cross(right);
    axes.col(2) = back;
    return Quat(axes).normalized();
}

Quat rotation_between(const Vec3& from, const Vec3& to) {
    const double cosine = from.dot(to);
    Vec3 axis = from.cross(to);
    if (cosine > -0.5) {
        return unit_quat(1.0 + cosine, axis.x(), axis.y(), axis.z());
    }
    // For nearly opposite directions, 1 + cosine and the axis lose digits. The half angle's cosine
    // and sine are therefore computed from the sum and the difference of the directions, which lose
    // none. The axis may be any direction perpendicular to `from`.
    if (axis.norm() < 1e-14) {
        axis = from.cross(std::abs(from.x()) < 0.7 ? Vec3::UnitX() : Vec3::UnitY());
    }
    axis.normalize();
    axis = (axis - from * from.dot(axis)).normalized();
    const Vec3 vector = axis * (from - to).norm();
    return Quat((from + to).norm(), vector.x(), vector.y(), vector.z()).normalized();
}

Quat interpolate(const Quat& a, const Quat& b, double t) {
    const Vec3 turn = rotation_to_vector(a.conjugate() * b);
    return (a * rotation_from_vector(t * turn)).normalized();
}

Pose interpolate(const Pose& a, const Pose& b, double t) {
    return {a.position + t * (b.position - a.position), interpolate(a.rotation, b.rotation, t)};
}

double smooth_step(double x, double from, double to) {
    const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

}  // namespace handhold

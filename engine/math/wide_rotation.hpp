#pragma once

#include "engine/math/trigonometry_series.hpp"
#include "engine/math/wide.hpp"

// Operations on four rotations, with the same steps as those on one rotation in math.cpp.
namespace handhold {

// Four at a time, bitwise equal to math.hpp's sin_cos.
HH_INLINE void sin_cos(const Double4& angle_rad, Double4& sine, Double4& cosine) {
    const Double4 shifted = angle_rad * k_two_over_pi + k_last_place_one;
    const Double4 x = reduced_angle(angle_rad, shifted - k_last_place_one);
    const Double4 s = sine_series(x);
    const Double4 c = cosine_series(x);
    const Mask4 quarters = __builtin_bit_cast(Mask4, shifted);
    const Mask4 is_odd = (quarters & 1) == 1;
    // Moves bit 1 of the quarter index, and of its successor, to the sign bit of a double.
    const Mask4 sine_sign = (quarters & 2) << 62;
    const Mask4 cosine_sign = ((quarters + 1) & 2) << 62;
    const Mask4 of_sine = __builtin_bit_cast(Mask4, is_odd ? c : s) ^ sine_sign;
    const Mask4 of_cosine = __builtin_bit_cast(Mask4, is_odd ? s : c) ^ cosine_sign;
    const Mask4 is_small =
        (angle_rad < k_largest_reduced_rad) & (angle_rad > -k_largest_reduced_rad);
    sine = is_small ? __builtin_bit_cast(Double4, of_sine) : zero4();
    cosine = is_small ? __builtin_bit_cast(Double4, of_cosine) : zero4() + 1.0;
}

// Rotation matrices by columns, which are the rotated coordinate axes.
struct WideAxes {
    Wide3 x, y, z;
};
HH_INLINE WideAxes axes_of(const Wide4& q) {
    const Double4 x2 = q.x + q.x;
    const Double4 y2 = q.y + q.y;
    const Double4 z2 = q.z + q.z;
    const Double4 xx = x2 * q.x;
    const Double4 yy = y2 * q.y;
    const Double4 zz = z2 * q.z;
    const Double4 xy = x2 * q.y;
    const Double4 xz = x2 * q.z;
    const Double4 yz = y2 * q.z;
    const Double4 wx = x2 * q.w;
    const Double4 wy = y2 * q.w;
    const Double4 wz = z2 * q.w;
    return {{1.0 - (yy + zz), xy + wz, xz - wy},
            {xy - wz, 1.0 - (xx + zz), yz + wx},
            {xz + wy, yz - wx, 1.0 - (xx + yy)}};
}
HH_INLINE Wide3 rotate(const WideAxes& axes, const Wide3& v) {
    return (v.x * axes.x + v.y * axes.y) + v.z * axes.z;
}
HH_INLINE Wide3 rotate_back(const WideAxes& axes, const Wide3& v) {
    return {dot(axes.x, v), dot(axes.y, v), dot(axes.z, v)};
}

// Normalised product (vector, w) * rotation.
HH_INLINE Wide4 turned(const Wide3& vector, const Double4& w, const Wide4& rotation) {
    const Wide3 before{rotation.x, rotation.y, rotation.z};
    const Wide3 v = (w * before + rotation.w * vector) + cross(vector, before);
    const Double4 scalar = w * rotation.w - dot(vector, before);
    const Double4 inverse_length =
        1.0 / square_root((v.x * v.x + v.y * v.y) + (v.z * v.z + scalar * scalar));
    return {v.x * inverse_length, v.y * inverse_length, v.z * inverse_length,
            scalar * inverse_length};
}

}  // namespace handhold

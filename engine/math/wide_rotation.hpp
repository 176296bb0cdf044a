#pragma once

#include "engine/math/trigonometry_series.hpp"
#include "engine/math/wide.hpp"

// Four rotations side by side. The same steps as math.cpp's for one.
namespace handhold {

// As math.hpp's, four at a time and with its bits.
HH_INLINE void sin_cos(const Four& angle_rad, Four& sine, Four& cosine) {
    const Four shifted = angle_rad * k_two_over_pi + k_last_place_one;
    const Four x = reduced_angle(angle_rad, shifted - k_last_place_one);
    const Four s = sine_series(x);
    const Four c = cosine_series(x);
    const FourBits quarters = __builtin_bit_cast(FourBits, shifted);
    const FourBits is_odd = (quarters & 1) == 1;
    // Bit 1 of the quarters, and of the next, where the sign of a double is.
    const FourBits sine_sign = (quarters & 2) << 62;
    const FourBits cosine_sign = ((quarters + 1) & 2) << 62;
    const FourBits of_sine = __builtin_bit_cast(FourBits, is_odd ? c : s) ^ sine_sign;
    const FourBits of_cosine = __builtin_bit_cast(FourBits, is_odd ? s : c) ^ cosine_sign;
    const FourBits is_small =
        (angle_rad < k_largest_reduced_rad) & (angle_rad > -k_largest_reduced_rad);
    sine = is_small ? __builtin_bit_cast(Four, of_sine) : zero_four();
    cosine = is_small ? __builtin_bit_cast(Four, of_cosine) : zero_four() + 1.0;
}

// Columns: where its own axes are.
struct WideAxes {
    Wide3 x, y, z;
};
HH_INLINE WideAxes axes_of(const Wide4& q) {
    const Four x2 = q.x + q.x;
    const Four y2 = q.y + q.y;
    const Four z2 = q.z + q.z;
    const Four xx = x2 * q.x;
    const Four yy = y2 * q.y;
    const Four zz = z2 * q.z;
    const Four xy = x2 * q.y;
    const Four xz = x2 * q.z;
    const Four yz = y2 * q.z;
    const Four wx = x2 * q.w;
    const Four wy = y2 * q.w;
    const Four wz = z2 * q.w;
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

// (vector, w) * rotation, of unit length.
HH_INLINE Wide4 turned(const Wide3& vector, const Four& w, const Wide4& rotation) {
    const Wide3 before{rotation.x, rotation.y, rotation.z};
    const Wide3 v = (w * before + rotation.w * vector) + cross(vector, before);
    const Four scalar = w * rotation.w - dot(vector, before);
    const Four by = 1.0 / square_root((v.x * v.x + v.y * v.y) + (v.z * v.z + scalar * scalar));
    return {v.x * by, v.y * by, v.z * by, scalar * by};
}

}  // namespace handhold

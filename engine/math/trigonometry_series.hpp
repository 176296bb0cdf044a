#pragma once

#include "engine/math/double4.hpp"

// Series of sine and cosine, and range reduction to [-pi/4, pi/4], for scalars and Double4. The
// reduction follows Cody and Waite 1980, with pi/2 in three parts. The Taylor series have
// remainders below half a unit in the last place.
namespace handhold {

inline constexpr double k_two_over_pi = 0.63661977236758134308;
// pi/2 = high + middle + low. `high` and `middle` have trailing zero bits, so that their multiples
// up to 2^20 are exact.
inline constexpr double k_half_pi_high = 1.57079632673412561417e+00;
inline constexpr double k_half_pi_middle = 6.07710050630396597660e-11;
inline constexpr double k_half_pi_low = 2.02226624879595063154e-21;
// 1.5 * 2^52. Doubles of this size have a spacing of 1, so adding it to a number rounds to the
// nearest integer. The low bits of the sum hold this integer.
inline constexpr double k_last_place_one = 6755399441055744.0;
// Largest angle that is reduced exactly.
inline constexpr double k_largest_reduced_rad = 1e6;

template <typename Number>
HH_INLINE Number reduced_angle(const Number& angle_rad, const Number& quarters) {
    const Number x = (angle_rad - quarters * k_half_pi_high) - quarters * k_half_pi_middle;
    return x - quarters * k_half_pi_low;
}

template <typename Number>
HH_INLINE Number sine_series(const Number& x) {
    const Number z = x * x;
    Number sum = 2.8114572543455206e-15 * z - 7.6471637318198164e-13;  // 1/17!, 1/15!
    sum = sum * z + 1.6059043836821613e-10;
    sum = sum * z - 2.5052108385441720e-08;
    sum = sum * z + 2.7557319223985893e-06;
    sum = sum * z - 1.9841269841269841e-04;
    sum = sum * z + 8.3333333333333332e-03;
    sum = sum * z - 1.6666666666666666e-01;
    return x + x * z * sum;
}

template <typename Number>
HH_INLINE Number cosine_series(const Number& x) {
    const Number z = x * x;
    Number sum = 4.7794773323873853e-14 * z - 1.1470745597729725e-11;  // 1/16!, 1/14!
    sum = sum * z + 2.0876756987868099e-09;
    sum = sum * z - 2.7557319223985888e-07;
    sum = sum * z + 2.4801587301587302e-05;
    sum = sum * z - 1.3888888888888889e-03;
    sum = sum * z + 4.1666666666666664e-02;
    return 1.0 - 0.5 * z + z * z * sum;
}

}  // namespace handhold

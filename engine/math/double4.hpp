#pragma once

#include "engine/math/math.hpp"

// Four doubles processed together: a vector with a fourth component 0, or a quaternion (x, y, z,
// w). Uses GCC's and Clang's vector types: one register with AVX, two without. Results are bitwise
// equal either way, because lanes are independent and sums across lanes have a fixed order.
// Everything is inlined, so that a function compiled for AVX uses AVX.
namespace handhold {

// The alignment is fixed, because GCC's default is smaller without AVX, and both builds must agree.
using Double4 = double __attribute__((vector_size(32), aligned(32)));

#define HH_INLINE [[gnu::always_inline]] inline

HH_INLINE Double4 to_double4(const Vec3& v) { return Double4{v.x(), v.y(), v.z(), 0.0}; }
HH_INLINE Double4 to_double4(const Quat& q) { return Double4{q.x(), q.y(), q.z(), q.w()}; }
HH_INLINE Vec3 to_vec3(const Double4& v) { return {v[0], v[1], v[2]}; }
HH_INLINE Quat to_quat(const Double4& q) { return {q[3], q[0], q[1], q[2]}; }

HH_INLINE Double4 zero4() { return Double4{0.0, 0.0, 0.0, 0.0}; }
HH_INLINE Double4 yzx(const Double4& v) { return __builtin_shufflevector(v, v, 1, 2, 0, 3); }
HH_INLINE Double4 cross(const Double4& a, const Double4& b) { return yzx(a * yzx(b) - yzx(a) * b); }
// Dot product of the first three components.
HH_INLINE double dot3(const Double4& a, const Double4& b) {
    const Double4 product = a * b;
    return (product[0] + product[1]) + product[2];
}

// A 3x3 matrix, stored by rows.
struct Rows3 {
    Double4 row[3];
};
// Sum of v[k] row[k] over k: the transposed matrix times v.
HH_INLINE Double4 combine(const Rows3& m, const Double4& v) {
    return (m.row[0] * v[0] + m.row[1] * v[1]) + m.row[2] * v[2];
}
// The matrix times v, summed in dot3's order.
HH_INLINE Double4 multiply(const Rows3& m, const Double4& v) {
    const Double4 a = m.row[0] * v;
    const Double4 b = m.row[1] * v;
    const Double4 c = m.row[2] * v;
    const Double4 ab_even = __builtin_shufflevector(a, b, 0, 4, 2, 6);  // a0 b0 a2 b2
    const Double4 ab_odd = __builtin_shufflevector(a, b, 1, 5, 3, 7);
    const Double4 c_even = __builtin_shufflevector(c, zero4(), 0, 4, 2, 6);
    const Double4 c_odd = __builtin_shufflevector(c, zero4(), 1, 5, 3, 7);
    return (__builtin_shufflevector(ab_even, c_even, 0, 1, 4, 5) +
            __builtin_shufflevector(ab_odd, c_odd, 0, 1, 4, 5)) +
           __builtin_shufflevector(ab_even, c_even, 2, 3, 6, 7);
}

}  // namespace handhold

#pragma once

#include "engine/math/math.hpp"

// Four doubles that are added and multiplied at once: vectors with a fourth number that is 0, or
// quaternions as (x, y, z, w). GCC's and Clang's vector types: with AVX one register, without two,
// and the same bits: lanes are computed alike, and sums across them have their order. All is
// inlined, so that a function built for AVX gets it built for AVX.
namespace handhold {

// GCC gives it less alignment where it does not build for AVX: it must be the same for both.
using Double4 = double __attribute__((vector_size(32), aligned(32)));

#define HH_INLINE [[gnu::always_inline]] inline

HH_INLINE Double4 to_double4(const Vec3& v) { return Double4{v.x(), v.y(), v.z(), 0.0}; }
HH_INLINE Double4 to_double4(const Quat& q) { return Double4{q.x(), q.y(), q.z(), q.w()}; }
HH_INLINE Vec3 to_vec3(const Double4& v) { return {v[0], v[1], v[2]}; }
HH_INLINE Quat to_quat(const Double4& q) { return {q[3], q[0], q[1], q[2]}; }

HH_INLINE Double4 zero4() { return Double4{0.0, 0.0, 0.0, 0.0}; }
HH_INLINE Double4 yzx(const Double4& v) { return __builtin_shufflevector(v, v, 1, 2, 0, 3); }
HH_INLINE Double4 cross(const Double4& a, const Double4& b) { return yzx(a * yzx(b) - yzx(a) * b); }
// Of the first three.
HH_INLINE double dot3(const Double4& a, const Double4& b) {
    const Double4 product = a * b;
    return (product[0] + product[1]) + product[2];
}

// A 3x3 matrix by rows.
struct Rows3 {
    Double4 row[3];
};
// Sum over k of v[k] rows[k]: the transposed matrix times v.
HH_INLINE Double4 combine(const Rows3& m, const Double4& v) {
    return (m.row[0] * v[0] + m.row[1] * v[1]) + m.row[2] * v[2];
}
// The matrix times v: sums in dot3's order.
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

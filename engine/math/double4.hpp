#pragma once

#include "engine/math/math.hpp"

// Four doubles that are added and multiplied at once: vectors with a fourth number that is 0, or
// quaternions as (x, y, z, w). GCC's and Clang's vector types: with AVX one register, without two,
// and the same bits: lanes are computed alike, and sums across them have their order. All is
// inlined, so that a function built for AVX gets it built for AVX.
namespace handhold {

// GCC gives it less alignment where it does not build for AVX: it must be the same for both.
using Four = double __attribute__((vector_size(32), aligned(32)));

#define HH_INLINE [[gnu::always_inline]] inline

HH_INLINE Four to_four(const Vec3& v) { return Four{v.x(), v.y(), v.z(), 0.0}; }
HH_INLINE Four to_four(const Quat& q) { return Four{q.x(), q.y(), q.z(), q.w()}; }
HH_INLINE Vec3 to_vec3(const Four& v) { return {v[0], v[1], v[2]}; }
HH_INLINE Quat to_quat(const Four& q) { return {q[3], q[0], q[1], q[2]}; }

HH_INLINE Four zero_four() { return Four{0.0, 0.0, 0.0, 0.0}; }
HH_INLINE Four yzx(const Four& v) { return __builtin_shufflevector(v, v, 1, 2, 0, 3); }
HH_INLINE Four cross(const Four& a, const Four& b) { return yzx(a * yzx(b) - yzx(a) * b); }
// Of the first three.
HH_INLINE double dot3(const Four& a, const Four& b) {
    const Four product = a * b;
    return (product[0] + product[1]) + product[2];
}

// A 3x3 matrix by rows.
struct Rows3 {
    Four row[3];
};
// Sum over k of v[k] rows[k]: the transposed matrix times v.
HH_INLINE Four combine(const Rows3& m, const Four& v) {
    return (m.row[0] * v[0] + m.row[1] * v[1]) + m.row[2] * v[2];
}
// The matrix times v: sums in dot3's order.
HH_INLINE Four multiply(const Rows3& m, const Four& v) {
    const Four a = m.row[0] * v;
    const Four b = m.row[1] * v;
    const Four c = m.row[2] * v;
    const Four ab_even = __builtin_shufflevector(a, b, 0, 4, 2, 6);  // a0 b0 a2 b2
    const Four ab_odd = __builtin_shufflevector(a, b, 1, 5, 3, 7);
    const Four c_even = __builtin_shufflevector(c, zero_four(), 0, 4, 2, 6);
    const Four c_odd = __builtin_shufflevector(c, zero_four(), 1, 5, 3, 7);
    return (__builtin_shufflevector(ab_even, c_even, 0, 1, 4, 5) +
            __builtin_shufflevector(ab_odd, c_odd, 0, 1, 4, 5)) +
           __builtin_shufflevector(ab_even, c_even, 2, 3, 6, 7);
}

}  // namespace handhold

#pragma once

#include <cstddef>
#include <cstdint>

#ifdef __SSE2__
#include <emmintrin.h>
#else
#include <cmath>
#endif

#include "engine/math/double4.hpp"

// Structure-of-arrays types: four vectors, rotations or matrices. Lane i of each member belongs to
// item i. All items are processed alike, and no number moves between lanes. Sums use double4.hpp's
// order, so results do not depend on the processor.
namespace handhold {

struct Wide3 {
    Double4 x, y, z;
};
struct Wide4 {
    Double4 x, y, z, w;
};
// Symmetric 3x3 matrices.
struct WideSymmetric {
    Double4 xx, yy, zz, xy, xz, yz;
};

// Assigns member by member. To assign the whole struct, GCC would copy through memory, in pieces of
// other sizes.
HH_INLINE void assign(const Wide3& from, Wide3& to) {
    to.x = from.x;
    to.y = from.y;
    to.z = from.z;
}
HH_INLINE void assign(const Wide4& from, Wide4& to) {
    to.x = from.x;
    to.y = from.y;
    to.z = from.z;
    to.w = from.w;
}
HH_INLINE void assign(const WideSymmetric& from, WideSymmetric& to) {
    to.xx = from.xx;
    to.yy = from.yy;
    to.zz = from.zz;
    to.xy = from.xy;
    to.xz = from.xz;
    to.yz = from.yz;
}

// Access to one lane.
HH_INLINE void set_lane(std::size_t lane, const Vec3& v, Wide3& out) {
    out.x[lane] = v.x();
    out.y[lane] = v.y();
    out.z[lane] = v.z();
}
HH_INLINE void set_lane(std::size_t lane, const Quat& q, Wide4& out) {
    out.x[lane] = q.x();
    out.y[lane] = q.y();
    out.z[lane] = q.z();
    out.w[lane] = q.w();
}
// Reads scalars one by one, like scalar_rotation.hpp: Eigen would load components in pairs and
// stall on stores that were just made one by one.
HH_INLINE void get_lane(std::size_t lane, const Wide3& v, Vec3& out) {
    out.x() = v.x[lane];
    out.y() = v.y[lane];
    out.z() = v.z[lane];
}
HH_INLINE void get_lane(std::size_t lane, const Wide4& q, Quat& out) {
    out.x() = q.x[lane];
    out.y() = q.y[lane];
    out.z() = q.z[lane];
    out.w() = q.w[lane];
}
HH_INLINE bool is_lane(std::size_t lane, const Wide3& v, const Vec3& of) {
    return v.x[lane] == of.x() && v.y[lane] == of.y() && v.z[lane] == of.z();
}
HH_INLINE bool is_lane(std::size_t lane, const Wide4& q, const Quat& of) {
    return q.x[lane] == of.x() && q.y[lane] == of.y() && q.z[lane] == of.z() && q.w[lane] == of.w();
}
HH_INLINE Quat quat_in_lane(std::size_t lane, const Wide4& q) {
    return {q.w[lane], q.x[lane], q.y[lane], q.z[lane]};
}

HH_INLINE Wide3 operator+(const Wide3& a, const Wide3& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
HH_INLINE Wide3 operator-(const Wide3& a, const Wide3& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
HH_INLINE Wide3 operator*(const Double4& factor, const Wide3& v) {
    return {factor * v.x, factor * v.y, factor * v.z};
}
HH_INLINE Double4 dot(const Wide3& a, const Wide3& b) {
    return (a.x * b.x + a.y * b.y) + a.z * b.z;
}
HH_INLINE Wide3 cross(const Wide3& a, const Wide3& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
HH_INLINE Wide3 multiply(const WideSymmetric& m, const Wide3& v) {
    return {(m.xx * v.x + m.xy * v.y) + m.xz * v.z, (m.xy * v.x + m.yy * v.y) + m.yz * v.z,
            (m.xz * v.x + m.yz * v.y) + m.zz * v.z};
}

// Like std::max, returns `a` if one argument is NaN.
HH_INLINE Double4 larger(const Double4& a, const Double4& b) { return b > a ? b : a; }
HH_INLINE double largest(const Double4& v) {
    const double low = v[1] > v[0] ? v[1] : v[0];
    const double high = v[3] > v[2] ? v[3] : v[2];
    return high > low ? high : low;
}

// Comparison result: each lane is 0 or -1 (all bits set).
using Mask4 = std::int64_t __attribute__((vector_size(32), aligned(32)));

// Uses the SSE2 instruction, because std::sqrt would check every sign for errno.
HH_INLINE Double4 square_root(const Double4& v) {
#ifdef __SSE2__
    const __m128d low = _mm_sqrt_pd(__m128d{v[0], v[1]});
    const __m128d high = _mm_sqrt_pd(__m128d{v[2], v[3]});
    return Double4{low[0], low[1], high[0], high[1]};
#else
    return Double4{std::sqrt(v[0]), std::sqrt(v[1]), std::sqrt(v[2]), std::sqrt(v[3])};
#endif
}

// --- Conversions between four separate vectors and structure-of-arrays ---------------------------

HH_INLINE Wide4 to_wide4(const Double4& a, const Double4& b, const Double4& c, const Double4& d) {
    const Double4 ab_even = __builtin_shufflevector(a, b, 0, 4, 2, 6);  // a0 b0 a2 b2
    const Double4 ab_odd = __builtin_shufflevector(a, b, 1, 5, 3, 7);
    const Double4 cd_even = __builtin_shufflevector(c, d, 0, 4, 2, 6);
    const Double4 cd_odd = __builtin_shufflevector(c, d, 1, 5, 3, 7);
    return {__builtin_shufflevector(ab_even, cd_even, 0, 1, 4, 5),
            __builtin_shufflevector(ab_odd, cd_odd, 0, 1, 4, 5),
            __builtin_shufflevector(ab_even, cd_even, 2, 3, 6, 7),
            __builtin_shufflevector(ab_odd, cd_odd, 2, 3, 6, 7)};
}
HH_INLINE Wide3 to_wide3(const Double4& a, const Double4& b, const Double4& c, const Double4& d) {
    const Wide4 all = to_wide4(a, b, c, d);
    return {all.x, all.y, all.z};
}

// Transposes: row i holds x, y, z and w of lane i.
HH_INLINE Wide4 to_rows(const Wide4& v) { return to_wide4(v.x, v.y, v.z, v.w); }
// The fourth component is 0.
HH_INLINE Wide4 to_rows(const Wide3& v) { return to_wide4(v.x, v.y, v.z, zero4()); }

}  // namespace handhold

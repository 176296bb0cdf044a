// Solver, packed: 3x3 blocks with one block per lane: inverses and products of the strands' factor.
// Included by triad_kernels.cpp only. The formulas are those of triad_factor.hpp, which stores one
// block per register row instead.

#pragma once

#include "engine/solver/packed/triad_bodies.hpp"
#include "engine/solver/packed/triad_factor.hpp"

namespace handhold::triads {

// --- Inverses ------------------------------------------------------------------------------------

HH_INLINE bool all_of(const Mask4& bits) {
    return ((bits[0] & bits[1]) & (bits[2] & bits[3])) != 0;
}

HH_INLINE Double4 inverse_pivot(const Double4& pivot, const Double4& min_pivot) {
    const Mask4 counts = (pivot > min_pivot) | (pivot < -min_pivot);
    return counts ? 1.0 / pivot : zero4();
}

// LDL^T: inverse pivots on the diagonal, l10, l20 and l21 in xy, xz and yz.
HH_INLINE void decompose(const WideSymmetric& m, const Wide3& diagonal, WideSymmetric& out) {
    const Wide3 min_pivot = (zero4() + k_smallest_pivot) * diagonal;
    out.xx = inverse_pivot(m.xx, min_pivot.x);
    out.xy = m.xy * out.xx;
    out.xz = m.xz * out.xx;
    out.yy = inverse_pivot(m.yy - out.xy * m.xy, min_pivot.y);
    const Double4 rest = m.yz - out.xz * m.xy;
    out.yz = rest * out.yy;
    out.zz = inverse_pivot((m.zz - out.xz * m.xz) - out.yz * rest, min_pivot.z);
}

// Returns true if `out` holds an LDL^T instead of the inverse. If one lane needs an LDL^T, all
// lanes get one.
HH_INLINE bool invert(const WideSymmetric& m, const Wide3& diagonal, WideSymmetric& out) {
    const Double4 xx = m.yy * m.zz - m.yz * m.yz;
    const Double4 xy = m.xz * m.yz - m.xy * m.zz;
    const Double4 xz = m.xy * m.yz - m.xz * m.yy;
    const Double4 determinant = (m.xx * xx + m.xy * xy) + m.xz * xz;
    const Double4 min_pivot = k_well_conditioned * ((diagonal.x * diagonal.y) * diagonal.z);
    if (!all_of(determinant > min_pivot)) {
        decompose(m, diagonal, out);
        return true;
    }
    const Double4 factor = 1.0 / determinant;
    out.xx = factor * xx;
    out.xy = factor * xy;
    out.xz = factor * xz;
    out.yy = factor * (m.xx * m.zz - m.xz * m.xz);
    out.yz = factor * (m.xy * m.xz - m.xx * m.yz);
    out.zz = factor * (m.xx * m.yy - m.xy * m.xy);
    return false;
}

HH_INLINE Wide3 divide(const WideSymmetric& pivots, const Wide3& v) {
    const Double4 y1 = v.y - v.x * pivots.xy;
    const Double4 y2 = (v.z - v.x * pivots.xz) - y1 * pivots.yz;
    const Double4 x2 = y2 * pivots.zz;
    const Double4 x1 = y1 * pivots.yy - x2 * pivots.yz;
    return {(v.x * pivots.xx - x2 * pivots.xz) - x1 * pivots.xy, x1, x2};
}
HH_INLINE Wide3 apply_inverse(const Links4& links, const Wide3& v) {
    return links.has_pivots ? divide(links.inverse, v) : multiply(links.inverse, v);
}

HH_INLINE void apply_inverse(const Links4& links, const WideMat3& m, WideMat3& out) {
    const WideSymmetric& w = links.inverse;
    if (links.has_pivots) {
        const Wide3 y1 = m.y - w.xy * m.x;
        const Wide3 y2 = (m.z - w.xz * m.x) - w.yz * y1;
        const Wide3 x2 = w.zz * y2;
        const Wide3 x1 = w.yy * y1 - w.yz * x2;
        assign((w.xx * m.x - w.xz * x2) - w.xy * x1, out.x);
        assign(x1, out.y);
        assign(x2, out.z);
        return;
    }
    assign((w.xx * m.x + w.xy * m.y) + w.xz * m.z, out.x);
    assign((w.xy * m.x + w.yy * m.y) + w.yz * m.z, out.y);
    assign((w.xz * m.x + w.yz * m.y) + w.zz * m.z, out.z);
}

// --- Products ----------------------------------------------------------------------------------

HH_INLINE WideSymmetric operator-(const WideSymmetric& a, const WideSymmetric& b) {
    return {a.xx - b.xx, a.yy - b.yy, a.zz - b.zz, a.xy - b.xy, a.xz - b.xz, a.yz - b.yz};
}
HH_INLINE WideSymmetric operator+(const WideSymmetric& a, const WideSymmetric& b) {
    return {a.xx + b.xx, a.yy + b.yy, a.zz + b.zz, a.xy + b.xy, a.xz + b.xz, a.yz + b.yz};
}
HH_INLINE Wide3 combine(const WideMat3& m, const Wide3& v) {
    return (v.x * m.x + v.y * m.y) + v.z * m.z;
}
HH_INLINE Wide3 multiply(const WideMat3& m, const Wide3& v) {
    return {dot(m.x, v), dot(m.y, v), dot(m.z, v)};
}
HH_INLINE WideMat3 transposed(const WideMat3& m) {
    return {{m.x.x, m.y.x, m.z.x}, {m.x.y, m.y.y, m.z.y}, {m.x.z, m.y.z, m.z.z}};
}
// a^T b
HH_INLINE WideMat3 product(const WideMat3& a, const WideMat3& b) {
    return {(a.x.x * b.x + a.y.x * b.y) + a.z.x * b.z, (a.x.y * b.x + a.y.y * b.y) + a.z.y * b.z,
            (a.x.z * b.x + a.y.z * b.y) + a.z.z * b.z};
}
// a^T b if the result is symmetric.
HH_INLINE WideSymmetric symmetric_product(const WideMat3& a, const WideMat3& b) {
    return {(a.x.x * b.x.x + a.y.x * b.y.x) + a.z.x * b.z.x,
            (a.x.y * b.x.y + a.y.y * b.y.y) + a.z.y * b.z.y,
            (a.x.z * b.x.z + a.y.z * b.y.z) + a.z.z * b.z.z,
            (a.x.x * b.x.y + a.y.x * b.y.y) + a.z.x * b.z.y,
            (a.x.x * b.x.z + a.y.x * b.y.z) + a.z.x * b.z.z,
            (a.x.y * b.x.z + a.y.y * b.y.z) + a.z.y * b.z.z};
}

}  // namespace handhold::triads

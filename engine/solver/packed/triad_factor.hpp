// Solver, packed: kernels of the sparse LDL^T of the triads outside strands, in 3x3 blocks.
// Included by triad_kernels.cpp only, and inlined there into functions for one processor type.
// Source: LDL^T by blocks as in Golub and Van Loan, Matrix Computations, 4.2.

#pragma once

#include <cmath>

#include "engine/solver/packed/triad_kernels.hpp"

namespace handhold::triads {

// --- Inverses ----------------------------------------------------------------------------------

// Blocks are inverted by cofactors, which takes one division instead of three dependent ones.
// Cofactors lose digits if triads are linearly dependent. After elimination, such a block is as
// small as alpha (1e-10 of its former diagonal) and a difference of large products. It gets an
// LDL^T instead, stored in place of the inverse. Row 0 holds the inverse pivots and, as fourth
// element, 1 (an inverse has 0 there). Row 1 holds l10, l20 and l21.

// A block gets an LDL^T if its determinant is less than this times the product of its diagonal
// before elimination.
inline constexpr double k_well_conditioned = 0.1;

HH_INLINE bool has_pivots(const Rows3& inverse) { return inverse.row[0][3] != 0.0; }

// 1 / pivot; 0 if the row is linearly dependent on others or if nothing can move it. The row's
// multiplier is then 0.
inline double inverse_pivot(double pivot, double min_pivots) {
    return std::abs(pivot) > min_pivots ? 1.0 / pivot : 0.0;
}

// Reads only the elements on and below the block's diagonal.
inline void decompose(const Rows3& block, const Double4& diagonal, Rows3& out) {
    const Double4 min_pivots = k_smallest_pivot * diagonal;
    const double d10 = block.row[1][0];
    const double d20 = block.row[2][0];
    const double p0 = inverse_pivot(block.row[0][0], min_pivots[0]);
    const double l10 = d10 * p0;
    const double l20 = d20 * p0;
    const double p1 = inverse_pivot(block.row[1][1] - l10 * d10, min_pivots[1]);
    const double remainder = block.row[2][1] - l20 * d10;
    const double l21 = remainder * p1;
    const double p2 = inverse_pivot((block.row[2][2] - l20 * d20) - l21 * remainder, min_pivots[2]);
    out.row[0] = Double4{p0, p1, p2, 1.0};
    out.row[1] = Double4{l10, l20, l21, 0.0};
    out.row[2] = zero4();
}

// The block's inverse times m, from its LDL^T.
inline void divide(const Rows3& pivots, const Rows3& m, Rows3& out) {
    const Double4& p = pivots.row[0];
    const double l10 = pivots.row[1][0];
    const double l20 = pivots.row[1][1];
    const double l21 = pivots.row[1][2];
    const Double4 y1 = m.row[1] - m.row[0] * l10;
    const Double4 y2 = (m.row[2] - m.row[0] * l20) - y1 * l21;
    const Double4 x2 = y2 * p[2];
    const Double4 x1 = y1 * p[1] - x2 * l21;
    out.row[0] = (m.row[0] * p[0] - x2 * l20) - x1 * l10;
    out.row[1] = x1;
    out.row[2] = x2;
}
inline void divide(const Rows3& pivots, const Double4& v, Double4& out) {
    const Double4& p = pivots.row[0];
    const double l10 = pivots.row[1][0];
    const double l20 = pivots.row[1][1];
    const double l21 = pivots.row[1][2];
    const double y1 = v[1] - v[0] * l10;
    const double y2 = (v[2] - v[0] * l20) - y1 * l21;
    const double x2 = y2 * p[2];
    const double x1 = y1 * p[1] - x2 * l21;
    const double x0 = (v[0] * p[0] - x2 * l20) - x1 * l10;
    out = Double4{x0, x1, x2, 0.0};
}

HH_INLINE void invert(const Rows3& block, const Double4& diagonal, Rows3& out) {
    const Double4 x = cross(block.row[1], block.row[2]);
    const double determinant = dot3(block.row[0], x);
    if (!(determinant > k_well_conditioned * ((diagonal[0] * diagonal[1]) * diagonal[2]))) {
        decompose(block, diagonal, out);
        return;
    }
    const double factor = 1.0 / determinant;
    out.row[0] = factor * x;
    out.row[1] = factor * cross(block.row[2], block.row[0]);
    out.row[2] = factor * cross(block.row[0], block.row[1]);
}
HH_INLINE void apply_inverse(const Rows3& inverse, const Rows3& m, Rows3& out) {
    if (has_pivots(inverse)) {
        divide(inverse, m, out);
        return;
    }
    out.row[0] = combine(m, inverse.row[0]);
    out.row[1] = combine(m, inverse.row[1]);
    out.row[2] = combine(m, inverse.row[2]);
}
HH_INLINE Double4 apply_inverse(const Rows3& inverse, const Double4& v) {
    if (has_pivots(inverse)) {
        Double4 out;
        divide(inverse, v, out);
        return out;
    }
    return combine(inverse, v);
}

// --- The factor --------------------------------------------------------------------------------

HH_INLINE Double4 diagonal_of(const Rows3& block) {
    const Double4 xy = __builtin_shufflevector(block.row[0], block.row[1], 0, 5, 2, 3);
    return __builtin_shufflevector(xy, block.row[2], 0, 1, 6, 3);
}

HH_INLINE void add_to_diagonal(const Double4& diagonal, Rows3& block) {
    const Double4 zero = zero4();
    block.row[0] += __builtin_shufflevector(diagonal, zero, 0, 5, 6, 7);
    block.row[1] += __builtin_shufflevector(diagonal, zero, 4, 1, 6, 7);
    block.row[2] += __builtin_shufflevector(diagonal, zero, 4, 5, 2, 7);
}

// out -= carried^T coupled.
HH_INLINE void subtract_product(const Rows3& carried, const Rows3& coupled, Rows3& out) {
    for (int i = 0; i < 3; ++i) {
        out.row[i] -= (coupled.row[0] * carried.row[0][i] + coupled.row[1] * carried.row[1][i]) +
                      coupled.row[2] * carried.row[2][i];
    }
}

HH_INLINE void eliminate(const TriadPlan::Step& step, const Rows3& inverse,
                         const TriadArrays& arrays) {
    const std::uint32_t count = step.later_end - step.later_begin;
    const std::uint32_t* target = arrays.plan->updates().data() + step.updates;
    Rows3* const coupled = arrays.blocks.data() + step.own + 1;
    for (std::uint32_t x = 0; x < count; ++x) {
        Rows3 carried;
        apply_inverse(inverse, coupled[x], carried);
        for (std::uint32_t y = x; y < count; ++y) {
            subtract_product(carried, coupled[y], arrays.blocks[*target++]);
        }
        coupled[x].row[0] = carried.row[0];
        coupled[x].row[1] = carried.row[1];
        coupled[x].row[2] = carried.row[2];
    }
}

struct Alpha {
    Double4 of_drives;
    double of_joints;  // relative to the diagonal
};

HH_INLINE void invert_step(std::size_t place, const Alpha& alpha, const TriadArrays& arrays) {
    const TriadPlan::Step& step = arrays.plan->steps()[place];
    const Double4 diagonal = arrays.unknowns[place].v;
    Double4 added = alpha.of_joints * diagonal;
    if (arrays.is_drive[step.node] != 0) {
        added = diagonal > 0.0 ? alpha.of_drives : zero4();
    }
    const Rows3& own = arrays.blocks[step.own];
    Rows3 block;
    block.row[0] = own.row[0];
    block.row[1] = own.row[1];
    block.row[2] = own.row[2];
    add_to_diagonal(added, block);
    invert(block, diagonal, arrays.inverses[place]);
}

// Saves the diagonals before elimination: pivots and determinants are compared with them.
HH_INLINE void note_diagonals(const TriadArrays& arrays) {
    const std::span<const TriadPlan::Step> steps = arrays.plan->steps();
    for (std::size_t i = 0; i < steps.size(); ++i) {
        arrays.unknowns[i].v = diagonal_of(arrays.blocks[steps[i].own]);
    }
}

HH_INLINE void factorise(const TriadArrays& arrays, double drive_alpha, double joint_alpha) {
    const std::span<const TriadPlan::Step> steps = arrays.plan->steps();
    const Alpha alpha{zero4() + drive_alpha, joint_alpha};
    for (std::size_t i = 0; i < steps.size(); ++i) {
        // An inverse has a long latency and depends only on its own block. The next step's inverse
        // overlaps with this step's elimination if the next step is independent of this one.
        if (i == 0 || !steps[i].is_independent) {
            invert_step(i, alpha, arrays);
        }
        if (i + 1 < steps.size() && steps[i + 1].is_independent) {
            invert_step(i + 1, alpha, arrays);
        }
        eliminate(steps[i], arrays.inverses[i], arrays);
    }
}

HH_INLINE void negate_values(const TriadArrays& arrays) {
    for (std::size_t i = 0; i < arrays.values.size(); ++i) {
        arrays.lambdas[i].v = -arrays.values[i].v;
    }
}

HH_INLINE void substitute(const TriadArrays& arrays) {
    const std::span<const TriadPlan::Step> steps = arrays.plan->steps();
    // Blocks and later nodes are stored in the order of the steps: each step's diagonal block, then
    // its blocks with later nodes.
    const Rows3* block = arrays.blocks.data();
    const std::uint32_t* later = arrays.plan->later().data();
    for (std::size_t i = 0; i < steps.size(); ++i) {
        const Double4 own = arrays.lambdas[steps[i].node].v;
        ++block;
        for (std::uint32_t left = steps[i].later_end - steps[i].later_begin; left > 0; --left) {
            arrays.lambdas[*later++].v -= combine(*block++, own);
        }
        arrays.unknowns[i].v = apply_inverse(arrays.inverses[i], own);
    }
    for (std::size_t i = steps.size(); i-- > 0;) {
        Double4 own = arrays.unknowns[i].v;
        for (std::uint32_t left = steps[i].later_end - steps[i].later_begin; left > 0; --left) {
            own -= multiply(*--block, arrays.lambdas[*--later].v);
        }
        --block;
        arrays.lambdas[steps[i].node].v = own;
    }
}

}  // namespace handhold::triads

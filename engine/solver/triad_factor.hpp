#pragma once

// Sources: LDL^T by blocks as in Golub and Van Loan, Matrix Computations, 4.2.
#include <cmath>

#include "engine/solver/triad_kernels.hpp"

// The triad kernels' sparse factor, block by block. Included by triad_kernels.cpp alone: all is
// inlined into functions for one kind of processor.
namespace handhold::triads {

// Blocks whose determinant is less than this share of their first diagonal's product are inverted
// by pivots: cofactors would lose too many digits.
inline constexpr double k_well_conditioned = 1e-6;

inline double inverse_pivot(double pivot, double least) {
    return std::abs(pivot) > least ? 1.0 / pivot : 0.0;
}

// By LDL^T. What has no pivot left, for it repeats other rows or nothing moves it, gets no share.
// Only what lies on and below the block's diagonal counts.
inline void invert_by_pivots(const Rows3& block, const Four& diagonal, Rows3& out) {
    const Four least = k_smallest_pivot * diagonal;
    const double d10 = block.row[1][0];
    const double d20 = block.row[2][0];
    const double p0 = inverse_pivot(block.row[0][0], least[0]);
    const double l10 = d10 * p0;
    const double l20 = d20 * p0;
    const double p1 = inverse_pivot(block.row[1][1] - l10 * d10, least[1]);
    const double rest = block.row[2][1] - l20 * d10;
    const double l21 = rest * p1;
    const double p2 = inverse_pivot((block.row[2][2] - l20 * d20) - l21 * rest, least[2]);
    const Four e0{1.0, 0.0, 0.0, 0.0};
    const Four y1 = Four{0.0, 1.0, 0.0, 0.0} - e0 * l10;
    const Four y2 = (Four{0.0, 0.0, 1.0, 0.0} - e0 * l20) - y1 * l21;
    const Four x2 = y2 * p2;
    const Four x1 = y1 * p1 - x2 * l21;
    out.row[0] = (e0 * p0 - x2 * l20) - x1 * l10;
    out.row[1] = x1;
    out.row[2] = x2;
}

// By cofactors: the three divisions of pivots wait for each other, this is one.
HH_INLINE void invert(const Rows3& block, const Four& diagonal, Rows3& out) {
    const Four x = cross(block.row[1], block.row[2]);
    const double determinant = dot3(block.row[0], x);
    if (!(determinant > k_well_conditioned * ((diagonal[0] * diagonal[1]) * diagonal[2]))) {
        invert_by_pivots(block, diagonal, out);
        return;
    }
    const double factor = 1.0 / determinant;
    out.row[0] = factor * x;
    out.row[1] = factor * cross(block.row[2], block.row[0]);
    out.row[2] = factor * cross(block.row[0], block.row[1]);
}

HH_INLINE Four diagonal_of(const Rows3& block) {
    const Four xy = __builtin_shufflevector(block.row[0], block.row[1], 0, 5, 2, 3);
    return __builtin_shufflevector(xy, block.row[2], 0, 1, 6, 3);
}

HH_INLINE void add_to_diagonal(const Four& diagonal, Rows3& block) {
    const Four zero = zero_four();
    block.row[0] += __builtin_shufflevector(diagonal, zero, 0, 5, 6, 7);
    block.row[1] += __builtin_shufflevector(diagonal, zero, 4, 1, 6, 7);
    block.row[2] += __builtin_shufflevector(diagonal, zero, 4, 5, 2, 7);
}

// out -= carried^T tied.
HH_INLINE void subtract_product(const Rows3& carried, const Rows3& tied, Rows3& out) {
    for (int i = 0; i < 3; ++i) {
        out.row[i] -= (tied.row[0] * carried.row[0][i] + tied.row[1] * carried.row[1][i]) +
                      tied.row[2] * carried.row[2][i];
    }
}

HH_INLINE void eliminate(const TriadPlan::Step& step, const Rows3& inverse,
                         const TriadArrays& arrays) {
    const std::uint32_t count = step.later_end - step.later_begin;
    const std::uint32_t* target = arrays.plan->updates().data() + step.updates;
    Rows3* const tied = arrays.blocks.data() + step.own + 1;
    for (std::uint32_t x = 0; x < count; ++x) {
        Rows3 carried;
        carried.row[0] = combine(tied[x], inverse.row[0]);
        carried.row[1] = combine(tied[x], inverse.row[1]);
        carried.row[2] = combine(tied[x], inverse.row[2]);
        for (std::uint32_t y = x; y < count; ++y) {
            subtract_product(carried, tied[y], arrays.blocks[*target++]);
        }
        tied[x].row[0] = carried.row[0];
        tied[x].row[1] = carried.row[1];
        tied[x].row[2] = carried.row[2];
    }
}

HH_INLINE void factorise(const TriadArrays& arrays, double hand_alpha, double joint_alpha) {
    const std::span<const TriadPlan::Step> steps = arrays.plan->steps();
    // Blocks are compared with the diagonal before others take their share of it.
    for (std::size_t i = 0; i < steps.size(); ++i) {
        arrays.unknowns[i].v = diagonal_of(arrays.blocks[steps[i].own]);
    }
    const Four of_hands = zero_four() + hand_alpha;
    for (std::size_t i = 0; i < steps.size(); ++i) {
        const Four diagonal = arrays.unknowns[i].v;
        Four alpha = joint_alpha * diagonal;
        if (arrays.hands[steps[i].node] != 0) {
            alpha = diagonal > 0.0 ? of_hands : zero_four();
        }
        const Rows3& own = arrays.blocks[steps[i].own];
        Rows3 block;
        block.row[0] = own.row[0];
        block.row[1] = own.row[1];
        block.row[2] = own.row[2];
        add_to_diagonal(alpha, block);
        invert(block, diagonal, arrays.inverses[i]);
        eliminate(steps[i], arrays.inverses[i], arrays);
    }
}

HH_INLINE void substitute(const TriadArrays& arrays) {
    const std::span<const TriadPlan::Step> steps = arrays.plan->steps();
    for (std::size_t i = 0; i < arrays.values.size(); ++i) {
        arrays.lambdas[i].v = -arrays.values[i].v;
    }
    for (std::size_t i = 0; i < steps.size(); ++i) {
        const Four own = arrays.lambdas[steps[i].node].v;
        const Rows3* carried = arrays.blocks.data() + steps[i].own + 1;
        for (const std::uint32_t later : arrays.plan->later(steps[i])) {
            arrays.lambdas[later].v -= combine(*carried++, own);
        }
        arrays.unknowns[i].v = combine(arrays.inverses[i], own);
    }
    for (std::size_t i = steps.size(); i-- > 0;) {
        Four own = arrays.unknowns[i].v;
        const Rows3* carried = arrays.blocks.data() + steps[i].own + 1;
        for (const std::uint32_t later : arrays.plan->later(steps[i])) {
            own -= multiply(*carried++, arrays.lambdas[later].v);
        }
        arrays.lambdas[steps[i].node].v = own;
    }
}

}  // namespace handhold::triads

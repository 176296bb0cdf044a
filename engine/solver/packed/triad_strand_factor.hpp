// Solver, packed: computes J W J^T of strands and eliminates their links. Included only by
// triad_kernels.cpp, as is triad_strands.hpp.

#pragma once

#include "engine/solver/packed/triad_strands.hpp"

namespace handhold::triads {

// Contributions of one row of a strand pack (one body per strand) to J W J^T. Each body couples two
// nodes: `before` and `after` belong to their diagonal blocks, `between` to the block between them.
struct WideCoupling {
    WideSymmetric before, after;
    WideMat3 between;  // rows of the node before, columns of the node after
};
HH_INLINE WideCoupling no_coupling() {
    const Double4 zero = zero4();
    return {{zero, zero, zero, zero, zero, zero},
            {zero, zero, zero, zero, zero, zero},
            {zero_wide3(), zero_wide3(), zero_wide3()}};
}
template <bool HasTurn>
HH_INLINE WideSymmetric own_product(const Wide3* side, const Ends4& end, const Double4& mass) {
    const Wide3 x = times_end<HasTurn>(side[0], end);
    const Wide3 y = times_end<HasTurn>(side[1], end);
    const Wide3 z = times_end<HasTurn>(side[2], end);
    const Double4 own = mass * end.sign;
    return {x.x + own, y.y + own, z.z + own, x.y, x.z, y.z};
}
template <bool HasTurn>
HH_INLINE WideCoupling couple(const Bodies4& bodies, const Ends4& before, const Ends4& after) {
    Wide3 side[3];
    write_side<HasTurn>(bodies.inverse_inertia, before, side);
    const Double4 mass = bodies.inverse_mass * before.sign;
    const Double4 shared = mass * after.sign;
    Wide3 x = times_end<HasTurn>(side[0], after);
    Wide3 y = times_end<HasTurn>(side[1], after);
    Wide3 z = times_end<HasTurn>(side[2], after);
    x.x += shared;
    y.y += shared;
    z.z += shared;
    const WideSymmetric of_before = own_product<HasTurn>(side, before, mass);
    write_side<HasTurn>(bodies.inverse_inertia, after, side);
    return {
        of_before, own_product<HasTurn>(side, after, bodies.inverse_mass * after.sign), {x, y, z}};
}

HH_INLINE void add_row(const Wide3& row, const TriadPlan::Lanes& blocks, int place,
                       const TriadArrays& arrays) {
    const Wide4 rows = to_rows(row);
    arrays.blocks[blocks[0]].row[place] += rows.x;
    arrays.blocks[blocks[1]].row[place] += rows.y;
    arrays.blocks[blocks[2]].row[place] += rows.z;
    arrays.blocks[blocks[3]].row[place] += rows.w;
}
HH_INLINE void add(const WideSymmetric& m, const TriadPlan::Lanes& blocks,
                   const TriadArrays& arrays) {
    add_row({m.xx, m.xy, m.xz}, blocks, 0, arrays);
    add_row({m.xy, m.yy, m.yz}, blocks, 1, arrays);
    add_row({m.xz, m.yz, m.zz}, blocks, 2, arrays);
}

// State of a strand pack's elimination.
struct StrandElimination {
    WideCoupling row;  // contribution of the bodies after the link eliminated last
    WideMat3 before;   // couples the current link with `before`
    WideSymmetric subtracted, subtracted_before;
    Wide3 diagonal;  // block of the link eliminated last, before its elimination
    Double4 inverse_sum;
};

// Eliminates one link of each of four strands. A link's block is the sum of the contributions of
// its two bodies: `of_first` from the first body, at.row from the second.
template <bool Carries>
HH_INLINE void eliminate_link(const WideSymmetric& of_first, double joint_alpha, Links4& links,
                              StrandElimination& at) {
    const WideSymmetric own = of_first + at.row.before;
    const Wide3 diagonal{own.xx, own.yy, own.zz};
    at.inverse_sum += 9.0 / ((own.xx + own.yy) + own.zz);
    WideSymmetric rest = own - at.subtracted;
    rest.xx += joint_alpha * diagonal.x;
    rest.yy += joint_alpha * diagonal.y;
    rest.zz += joint_alpha * diagonal.z;
    links.has_pivots = invert(rest, diagonal, links.inverse);
    apply_inverse(links, at.row.between, links.next);
    at.subtracted = symmetric_product(at.row.between, links.next);
    if (Carries) {
        apply_inverse(links, at.before, links.before);
        at.subtracted_before = at.subtracted_before + symmetric_product(at.before, links.before);
        const WideMat3 carried = product(at.row.between, links.before);
        at.before = {zero_wide3() - carried.x, zero_wide3() - carried.y, zero_wide3() - carried.z};
    }
    assign(diagonal, at.diagonal);
}

// True if the coupling of the current link with `before` is negligible in all lanes, relative to
// the link's own block. The coupling fades by a constant factor per link.
HH_INLINE bool is_coupling_negligible(const StrandElimination& at) {
    constexpr double k_negligible = 1e-30;
    const Double4 square = (dot(at.before.x, at.before.x) + dot(at.before.y, at.before.y)) +
                           dot(at.before.z, at.before.z);
    return all_of(square <= (k_negligible * k_negligible) * dot(at.diagonal, at.diagonal));
}

// Eliminates the links of a strand pack, each as soon as both its bodies have contributed. The next
// row's product then overlaps with the latency of the link's inverse. Returns the first step that
// is not coupled with `before`.
template <bool HasTurn>
HH_INLINE std::size_t eliminate_links(const StrandPackRange& part, const StrandPackArrays& of,
                                      double joint_alpha, StrandElimination& at) {
    constexpr std::size_t k_check_interval =
        8;  // test for a negligible coupling every this many links
    const std::size_t end = part.has_after ? part.end_step : part.end_step - 1;
    std::size_t k = part.first_step;
    bool carries = part.has_before;
    for (; carries && k < end; ++k) {
        const WideSymmetric of_first = at.row.after;
        at.row = couple<HasTurn>(of.bodies[k + 1], of.ends[2 * k + 2], of.ends[2 * k + 3]);
        eliminate_link<true>(of_first, joint_alpha, of.links[k], at);
        carries = k % k_check_interval != 0 || !is_coupling_negligible(at);
    }
    const std::size_t decoupled = k;
    if (!carries) {
        at.before = {zero_wide3(), zero_wide3(), zero_wide3()};
    }
    for (; k < end; ++k) {
        const WideSymmetric of_first = at.row.after;
        at.row = couple<HasTurn>(of.bodies[k + 1], of.ends[2 * k + 2], of.ends[2 * k + 3]);
        eliminate_link<false>(of_first, joint_alpha, of.links[k], at);
    }
    if (k < part.end_step) {  // the link between the last active bodies and inactive ones
        const WideSymmetric of_first = at.row.after;
        at.row = no_coupling();
        eliminate_link<true>(of_first, joint_alpha, of.links[k], at);
    }
    return carries ? part.end_step : decoupled;
}

template <bool HasTurn>
HH_INLINE void eliminate_strand_pack(const TriadPlan::StrandPack& strand_pack,
                                     const StrandPackRange& part, double joint_alpha,
                                     const TriadArrays& arrays, Strands4& remainder) {
    const StrandPackArrays of = part_of(strand_pack, arrays);
    const Double4 zero = zero4();
    // Writes all inertias first, so that their latencies overlap.
    for (std::size_t row = part.begin; row < part.end; ++row) {
        write_inertia(strand_pack.row + row, arrays);
    }
    StrandElimination at;
    at.row = no_coupling();
    if (part.has_before) {
        at.row = couple<HasTurn>(of.bodies[0], of.ends[0], of.ends[1]);
        add(at.row.before, strand_pack.block_before, arrays);
    }
    at.before = transposed(at.row.between);
    at.subtracted = {zero, zero, zero, zero, zero, zero};
    at.subtracted_before = at.subtracted;
    at.inverse_sum = zero;
    remainder.decoupled_step = eliminate_links<HasTurn>(part, of, joint_alpha, at);
    add(at.row.after, strand_pack.block_after, arrays);
    assign(at.subtracted_before, remainder.before);
    assign(at.subtracted, remainder.after);
    assign(at.before.x, remainder.between.x);
    assign(at.before.y, remainder.between.y);
    assign(at.before.z, remainder.between.z);
    remainder.inverse_sum = at.inverse_sum;
}

HH_INLINE void eliminate_strands(const TriadArrays& arrays, double joint_alpha) {
    const std::span<const TriadPlan::StrandPack> strand_packs = arrays.plan->strand_packs();
    for (std::size_t i = 0; i < strand_packs.size(); ++i) {
        const StrandPackRange part = part_in(arrays.windows[i], strand_packs[i]);
        if (arrays.has_turn) {
            eliminate_strand_pack<true>(strand_packs[i], part, joint_alpha, arrays,
                                        arrays.strands[i]);
        } else {
            eliminate_strand_pack<false>(strand_packs[i], part, joint_alpha, arrays,
                                         arrays.strands[i]);
        }
    }
}

// Adds `between`, the coupling of the nodes `before` and `after`, to the block between them. The
// rows of that block belong to the node that is eliminated first, so some lanes need the transpose.
HH_INLINE void add_between(const WideMat3& between, const TriadPlan::StrandPack& strand_pack,
                           const TriadArrays& arrays) {
    const WideMat3 turned = transposed(between);
    const Wide3* const rows[3] = {&between.x, &between.y, &between.z};
    const Wide3* const turned_rows[3] = {&turned.x, &turned.y, &turned.z};
    for (int i = 0; i < 3; ++i) {
        const Wide4 of_after = to_rows(*rows[i]);
        const Wide4 of_before = to_rows(*turned_rows[i]);
        const Double4* const lanes[2][4] = {
            {&of_after.x, &of_after.y, &of_after.z, &of_after.w},
            {&of_before.x, &of_before.y, &of_before.z, &of_before.w}};
        for (std::size_t lane = 0; lane < 4; ++lane) {
            arrays.blocks[strand_pack.block_between[lane]].row[i] +=
                *lanes[strand_pack.before_first[lane] ? 1 : 0][lane];
        }
    }
}

// Applies the Schur complements of the eliminated strands to the blocks of the remaining nodes.
HH_INLINE void subtract_strands(const TriadArrays& arrays) {
    const std::span<const TriadPlan::StrandPack> strand_packs = arrays.plan->strand_packs();
    const Double4 zero = zero4();
    const WideSymmetric none{zero, zero, zero, zero, zero, zero};
    for (std::size_t i = 0; i < strand_packs.size(); ++i) {
        const Strands4& remainder = arrays.strands[i];
        add(none - remainder.before, strand_packs[i].block_before, arrays);
        add(none - remainder.after, strand_packs[i].block_after, arrays);
        add_between(remainder.between, strand_packs[i], arrays);
    }
}

}  // namespace handhold::triads

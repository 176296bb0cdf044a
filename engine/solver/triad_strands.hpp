#pragma once

// Sources: block LDL^T as in triad_factor.hpp; nested dissection after George (1973).
#include "engine/solver/triad_bodies.hpp"
#include "engine/solver/triad_factor.hpp"

// The triad kernels for strands: four of them side by side in a register's lanes, so that nothing
// moves between lanes but at their ends. Included by triad_kernels.cpp alone: all is inlined into
// functions for one kind of processor.
namespace handhold::triads {

// A braid's part of the arrays.
struct BraidArrays {
    FourBodies* bodies;  // by row
    FourEnds* ends;      // 2 * row: those of the node before, then those of the node after
    FourLinks* links;    // by step
    Wide3* multipliers;  // of `before`, of each step, of `after`
};
HH_INLINE BraidArrays part_of(const TriadPlan::Braid& braid, const TriadArrays& arrays) {
    return {arrays.bodies.data() + braid.row, arrays.body_ends.data() + std::size_t{2} * braid.row,
            arrays.links.data() + braid.step, arrays.multipliers.data() + braid.bound};
}

// --- Values ------------------------------------------------------------------------------------

HH_INLINE void evaluate_strands(const TriadArrays& arrays) {
    for (const TriadPlan::Braid& braid : arrays.plan->braids()) {
        const BraidArrays of = part_of(braid, arrays);
        write_axes(of.bodies[0]);
        write_ends(part_of(of.bodies[0], of.ends[0]), braid.before, arrays);
        Wide3 first = part_of(of.bodies[0], of.ends[1]);
        for (std::size_t row = 1; row <= braid.length; ++row) {
            write_axes(of.bodies[row]);
            assign(first + part_of(of.bodies[row], of.ends[2 * row]), of.links[row - 1].value);
            first = part_of(of.bodies[row], of.ends[2 * row + 1]);
        }
        write_ends(first, braid.after, arrays);
    }
}

template <bool HasTurn>
HH_INLINE void evaluate_strand_velocities(const TriadArrays& arrays) {
    for (const TriadPlan::Braid& braid : arrays.plan->braids()) {
        const BraidArrays of = part_of(braid, arrays);
        write_ends(speed_of<HasTurn>(of.bodies[0], of.ends[0]), braid.before, arrays);
        Wide3 first = speed_of<HasTurn>(of.bodies[0], of.ends[1]);
        for (std::size_t row = 1; row <= braid.length; ++row) {
            assign(first + speed_of<HasTurn>(of.bodies[row], of.ends[2 * row]),
                   of.links[row - 1].value);
            first = speed_of<HasTurn>(of.bodies[row], of.ends[2 * row + 1]);
        }
        write_ends(first, braid.after, arrays);
    }
}
HH_INLINE void evaluate_strand_velocities(const TriadArrays& arrays) {
    arrays.has_turn ? evaluate_strand_velocities<true>(arrays)
                    : evaluate_strand_velocities<false>(arrays);
}

HH_INLINE double worst_strand_square(const TriadArrays& arrays) {
    Four worst = zero_four();
    for (const FourLinks& links : arrays.links) {
        worst = larger(worst, dot(links.value, links.value));
    }
    return largest(worst);
}

HH_INLINE void gather_strand_stiffness(const TriadArrays& arrays) {
    const Four zero = zero_four();
    for (const TriadPlan::Braid& braid : arrays.plan->braids()) {
        const BraidArrays of = part_of(braid, arrays);
        for (std::size_t row = 0; row <= braid.length; ++row) {
            WideSymmetric sum{zero, zero, zero, zero, zero, zero};
            add_stiffness(of.multipliers[row], of.ends[2 * row].arm, sum);
            add_stiffness(of.multipliers[row + 1], of.ends[2 * row + 1].arm, sum);
            assign(sum, arrays.stiffness[braid.row + row]);
        }
    }
}

// --- Inverses: as triad_factor.hpp's, in each lane ---------------------------------------------

HH_INLINE bool all_of(const FourBits& bits) {
    return ((bits[0] & bits[1]) & (bits[2] & bits[3])) != 0;
}

HH_INLINE Four inverse_pivot(const Four& pivot, const Four& least) {
    const FourBits counts = (pivot > least) | (pivot < -least);
    return counts ? 1.0 / pivot : zero_four();
}

// The inverse pivots on the diagonal, l10, l20 and l21 beside it.
HH_INLINE void decompose(const WideSymmetric& m, const Wide3& diagonal, WideSymmetric& out) {
    const Wide3 least = (zero_four() + k_smallest_pivot) * diagonal;
    out.xx = inverse_pivot(m.xx, least.x);
    out.xy = m.xy * out.xx;
    out.xz = m.xz * out.xx;
    out.yy = inverse_pivot(m.yy - out.xy * m.xy, least.y);
    const Four rest = m.yz - out.xz * m.xy;
    out.yz = rest * out.yy;
    out.zz = inverse_pivot((m.zz - out.xz * m.xz) - out.yz * rest, least.z);
}

// True where it has pivots in the inverse's place: in all lanes, if one of them needs them.
HH_INLINE bool invert(const WideSymmetric& m, const Wide3& diagonal, WideSymmetric& out) {
    const Four xx = m.yy * m.zz - m.yz * m.yz;
    const Four xy = m.xz * m.yz - m.xy * m.zz;
    const Four xz = m.xy * m.yz - m.xz * m.yy;
    const Four determinant = (m.xx * xx + m.xy * xy) + m.xz * xz;
    const Four least = k_well_conditioned * ((diagonal.x * diagonal.y) * diagonal.z);
    if (!all_of(determinant > least)) {
        decompose(m, diagonal, out);
        return true;
    }
    const Four factor = 1.0 / determinant;
    out.xx = factor * xx;
    out.xy = factor * xy;
    out.xz = factor * xz;
    out.yy = factor * (m.xx * m.zz - m.xz * m.xz);
    out.yz = factor * (m.xy * m.xz - m.xx * m.yz);
    out.zz = factor * (m.xx * m.yy - m.xy * m.xy);
    return false;
}

HH_INLINE Wide3 divide(const WideSymmetric& pivots, const Wide3& v) {
    const Four y1 = v.y - v.x * pivots.xy;
    const Four y2 = (v.z - v.x * pivots.xz) - y1 * pivots.yz;
    const Four x2 = y2 * pivots.zz;
    const Four x1 = y1 * pivots.yy - x2 * pivots.yz;
    return {(v.x * pivots.xx - x2 * pivots.xz) - x1 * pivots.xy, x1, x2};
}
HH_INLINE Wide3 apply_inverse(const FourLinks& links, const Wide3& v) {
    return links.has_pivots ? divide(links.inverse, v) : multiply(links.inverse, v);
}

HH_INLINE void apply_inverse(const FourLinks& links, const WideSquare& m, WideSquare& out) {
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
HH_INLINE Wide3 combine(const WideSquare& m, const Wide3& v) {
    return (v.x * m.x + v.y * m.y) + v.z * m.z;
}
HH_INLINE Wide3 multiply(const WideSquare& m, const Wide3& v) {
    return {dot(m.x, v), dot(m.y, v), dot(m.z, v)};
}
HH_INLINE WideSquare transposed(const WideSquare& m) {
    return {{m.x.x, m.y.x, m.z.x}, {m.x.y, m.y.y, m.z.y}, {m.x.z, m.y.z, m.z.z}};
}
// a^T b
HH_INLINE WideSquare product(const WideSquare& a, const WideSquare& b) {
    return {(a.x.x * b.x + a.y.x * b.y) + a.z.x * b.z, (a.x.y * b.x + a.y.y * b.y) + a.z.y * b.z,
            (a.x.z * b.x + a.y.z * b.y) + a.z.z * b.z};
}
// The same where it is symmetric.
HH_INLINE WideSymmetric symmetric_product(const WideSquare& a, const WideSquare& b) {
    return {(a.x.x * b.x.x + a.y.x * b.y.x) + a.z.x * b.z.x,
            (a.x.y * b.x.y + a.y.y * b.y.y) + a.z.y * b.z.y,
            (a.x.z * b.x.z + a.y.z * b.y.z) + a.z.z * b.z.z,
            (a.x.x * b.x.y + a.y.x * b.y.y) + a.z.x * b.z.y,
            (a.x.x * b.x.z + a.y.x * b.y.z) + a.z.x * b.z.z,
            (a.x.y * b.x.z + a.y.y * b.y.z) + a.z.y * b.z.z};
}

// --- J W J^T and the factor --------------------------------------------------------------------

// What a row's bodies add to the blocks of their two nodes.
struct WideCoupling {
    WideSymmetric before, after;
    WideSquare between;  // rows of the node before
};
template <bool HasTurn>
HH_INLINE WideSymmetric own_product(const Wide3* side, const FourEnds& end, const Four& mass) {
    const Wide3 x = times_end<HasTurn>(side[0], end);
    const Wide3 y = times_end<HasTurn>(side[1], end);
    const Wide3 z = times_end<HasTurn>(side[2], end);
    const Four own = mass * end.sign;
    return {x.x + own, y.y + own, z.z + own, x.y, x.z, y.z};
}
template <bool HasTurn>
HH_INLINE WideCoupling couple(const FourBodies& bodies, const FourEnds& before,
                              const FourEnds& after) {
    Wide3 side[3];
    write_side<HasTurn>(bodies.inverse_inertia, before, side);
    const Four mass = bodies.inverse_mass * before.sign;
    const Four shared = mass * after.sign;
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

// Each link goes as soon as both its bodies have been: in the shadow of its inverse, which takes
// long, lies the next row's product.
template <bool HasTurn>
HH_INLINE void eliminate_braid(const TriadPlan::Braid& braid, double joint_alpha,
                               const TriadArrays& arrays, FourStrands& left) {
    const BraidArrays of = part_of(braid, arrays);
    const Four zero = zero_four();
    // Of all first: what one row's takes its time for, others do not wait for.
    for (std::size_t row = braid.row; row <= braid.row + std::size_t{braid.length}; ++row) {
        write_inertia(row, arrays);
    }
    WideCoupling row = couple<HasTurn>(of.bodies[0], of.ends[0], of.ends[1]);
    add(row.before, braid.block_before, arrays);
    WideSquare before = transposed(row.between);  // of the link at hand with `before`
    WideSymmetric taken{zero, zero, zero, zero, zero, zero};
    WideSymmetric taken_before = taken;
    Four inverse_sum = zero;
    for (std::size_t k = 0; k < braid.length; ++k) {
        const WideSymmetric of_first = row.after;
        row = couple<HasTurn>(of.bodies[k + 1], of.ends[2 * k + 2], of.ends[2 * k + 3]);
        const WideSymmetric own = of_first + row.before;
        const Wide3 diagonal{own.xx, own.yy, own.zz};
        inverse_sum += 9.0 / ((own.xx + own.yy) + own.zz);
        WideSymmetric rest = own - taken;
        rest.xx += joint_alpha * diagonal.x;
        rest.yy += joint_alpha * diagonal.y;
        rest.zz += joint_alpha * diagonal.z;
        FourLinks& links = of.links[k];
        links.has_pivots = invert(rest, diagonal, links.inverse);
        apply_inverse(links, row.between, links.next);
        apply_inverse(links, before, links.before);
        taken = symmetric_product(row.between, links.next);
        taken_before = taken_before + symmetric_product(before, links.before);
        const WideSquare carried = product(row.between, links.before);
        before = {zero_three() - carried.x, zero_three() - carried.y, zero_three() - carried.z};
    }
    add(row.after, braid.block_after, arrays);
    assign(taken_before, left.before);
    assign(taken, left.after);
    assign(before.x, left.between.x);
    assign(before.y, left.between.y);
    assign(before.z, left.between.z);
    left.inverse_sum = inverse_sum;
}

HH_INLINE void eliminate_strands(const TriadArrays& arrays, double joint_alpha) {
    const std::span<const TriadPlan::Braid> braids = arrays.plan->braids();
    for (std::size_t i = 0; i < braids.size(); ++i) {
        if (arrays.has_turn) {
            eliminate_braid<true>(braids[i], joint_alpha, arrays, arrays.strands[i]);
        } else {
            eliminate_braid<false>(braids[i], joint_alpha, arrays, arrays.strands[i]);
        }
    }
}

// A block's rows are those of the node that goes first.
HH_INLINE void add_between(const WideSquare& between, const TriadPlan::Braid& braid,
                           const TriadArrays& arrays) {
    const WideSquare turned = transposed(between);
    const Wide3* const rows[3] = {&between.x, &between.y, &between.z};
    const Wide3* const turned_rows[3] = {&turned.x, &turned.y, &turned.z};
    for (int i = 0; i < 3; ++i) {
        const Wide4 of_after = to_rows(*rows[i]);
        const Wide4 of_before = to_rows(*turned_rows[i]);
        const Four* const lanes[2][4] = {{&of_after.x, &of_after.y, &of_after.z, &of_after.w},
                                         {&of_before.x, &of_before.y, &of_before.z, &of_before.w}};
        for (std::size_t lane = 0; lane < 4; ++lane) {
            arrays.blocks[braid.block_between[lane]].row[i] +=
                *lanes[braid.before_first[lane] ? 1 : 0][lane];
        }
    }
}

// From the rest's blocks.
HH_INLINE void take_off_strands(const TriadArrays& arrays) {
    const std::span<const TriadPlan::Braid> braids = arrays.plan->braids();
    const Four zero = zero_four();
    const WideSymmetric none{zero, zero, zero, zero, zero, zero};
    for (std::size_t i = 0; i < braids.size(); ++i) {
        const FourStrands& left = arrays.strands[i];
        add(none - left.before, braids[i].block_before, arrays);
        add(none - left.after, braids[i].block_after, arrays);
        add_between(left.between, braids[i], arrays);
    }
}

// --- Substitution ------------------------------------------------------------------------------

HH_INLINE void take_off_lambdas(const Wide3& v, const TriadPlan::Lanes& ends,
                                const TriadArrays& arrays) {
    const Wide4 rows = to_rows(v);
    arrays.lambdas[ends[0] / 2].v -= rows.x;
    arrays.lambdas[ends[1] / 2].v -= rows.y;
    arrays.lambdas[ends[2] / 2].v -= rows.z;
    arrays.lambdas[ends[3] / 2].v -= rows.w;
}

HH_INLINE void substitute_into_strands(const TriadArrays& arrays) {
    for (const TriadPlan::Braid& braid : arrays.plan->braids()) {
        FourLinks* const links = arrays.links.data() + braid.step;
        Wide3 of_next = zero_three();
        Wide3 of_before = zero_three();
        for (std::size_t k = 0; k < braid.length; ++k) {
            const Wide3 own = (zero_three() - links[k].value) - of_next;
            of_next = combine(links[k].next, own);
            of_before = of_before + combine(links[k].before, own);
            assign(apply_inverse(links[k], own), links[k].unknown);
        }
        take_off_lambdas(of_before, braid.before, arrays);
        take_off_lambdas(of_next, braid.after, arrays);
    }
}

HH_INLINE void substitute_back_into_strands(const TriadArrays& arrays) {
    for (const TriadPlan::Braid& braid : arrays.plan->braids()) {
        const BraidArrays of = part_of(braid, arrays);
        const Wide3 before = lambdas_of(braid.before, arrays);
        Wide3 own = lambdas_of(braid.after, arrays);
        assign(before, of.multipliers[0]);
        assign(own, of.multipliers[braid.length + 1]);
        for (std::size_t k = braid.length; k-- > 0;) {
            const FourLinks& links = of.links[k];
            own = (links.unknown - multiply(links.before, before)) - multiply(links.next, own);
            assign(own, of.multipliers[k + 1]);
        }
    }
}

HH_INLINE TriadReach gather_strand_moves(const TriadArrays& arrays) {
    WideReach reach;
    for (const TriadPlan::Braid& braid : arrays.plan->braids()) {
        const BraidArrays of = part_of(braid, arrays);
        for (std::size_t row = 0; row <= braid.length; ++row) {
            WideWrench wrench{zero_three(), zero_three()};
            add_end(of.ends[2 * row], of.multipliers[row], arrays.has_turn, wrench);
            add_end(of.ends[2 * row + 1], of.multipliers[row + 1], arrays.has_turn, wrench);
            take_moves(wrench, of.bodies[row], reach);
        }
    }
    return {largest(reach.move), largest(reach.turn)};
}

}  // namespace handhold::triads

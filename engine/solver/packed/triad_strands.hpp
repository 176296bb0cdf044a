// Solver, packed: kernels for strands, four strands side by side in a register's lanes. Nothing
// crosses lanes except at the strands' ends. Included by triad_kernels.cpp only, and inlined there
// into functions for one processor type.
// Sources: block LDL^T as in triad_factor.hpp; nested dissection after George (1973).

#pragma once

#include "engine/solver/packed/triad_bodies.hpp"
#include "engine/solver/packed/triad_lane_blocks.hpp"

namespace handhold::triads {

// The elements of TriadArrays that belong to one strand pack.
struct StrandPackArrays {
    Bodies4* bodies;  // by row
    Ends4* ends;  // [2 * row]: the row's ends of the link before; [2 * row + 1]: of the link after
    Links4* links;       // by step
    Wide3* multipliers;  // of `before`, of each step, of `after`
};
HH_INLINE StrandPackArrays part_of(const TriadPlan::StrandPack& strand_pack,
                                   const TriadArrays& arrays) {
    return {arrays.bodies.data() + strand_pack.row,
            arrays.body_ends.data() + std::size_t{2} * strand_pack.row,
            arrays.links.data() + strand_pack.step, arrays.multipliers.data() + strand_pack.bound};
}

// Rows of a window, and the steps whose links have a body in these rows.
struct StrandPackRange {
    std::size_t begin, end;            // rows
    std::size_t first_step, end_step;  // step k connects rows k and k + 1
    // whether the first row of the strand pack is included, and the last
    bool has_before, has_after;
};
HH_INLINE StrandPackRange part_in(const RowWindow& window,
                                  const TriadPlan::StrandPack& strand_pack) {
    const bool has_before = window.begin == 0;
    const bool has_after = window.end > strand_pack.length;
    return {window.begin,
            window.end,
            has_before ? std::size_t{0} : window.begin - std::size_t{1},
            has_after ? std::size_t{strand_pack.length} : std::size_t{window.end},
            has_before,
            has_after};
}

// --- Values ------------------------------------------------------------------------------------

HH_INLINE void evaluate_strand_pack(const TriadPlan::StrandPack& strand_pack,
                                    const StrandPackRange& part, const TriadArrays& arrays) {
    const StrandPackArrays of = part_of(strand_pack, arrays);
    if (part.has_before) {
        write_axes(of.bodies[0]);
        write_ends(part_of(of.bodies[0], of.ends[0]), strand_pack.before, arrays);
    }
    Wide3 first = part_of(of.bodies[part.first_step], of.ends[2 * part.first_step + 1]);
    for (std::size_t step = part.first_step; step < part.end_step; ++step) {
        const std::size_t row = step + 1;
        if (row < part.end) {
            write_axes(of.bodies[row]);
        }
        assign(first + part_of(of.bodies[row], of.ends[2 * row]), of.links[step].value);
        first = part_of(of.bodies[row], of.ends[2 * row + 1]);
    }
    if (part.has_after) {
        write_ends(first, strand_pack.after, arrays);
    }
}
HH_INLINE void evaluate_strands(const TriadArrays& arrays) {
    const std::span<const TriadPlan::StrandPack> strand_packs = arrays.plan->strand_packs();
    for (std::size_t i = 0; i < strand_packs.size(); ++i) {
        evaluate_strand_pack(strand_packs[i], part_in(arrays.windows[i], strand_packs[i]), arrays);
    }
}

template <bool HasTurn>
HH_INLINE void evaluate_strand_velocities(const TriadArrays& arrays) {
    for (const TriadPlan::StrandPack& strand_pack : arrays.plan->strand_packs()) {
        const StrandPackArrays of = part_of(strand_pack, arrays);
        write_ends(speed_of<HasTurn>(of.bodies[0], of.ends[0]), strand_pack.before, arrays);
        Wide3 first = speed_of<HasTurn>(of.bodies[0], of.ends[1]);
        for (std::size_t row = 1; row <= strand_pack.length; ++row) {
            assign(first + speed_of<HasTurn>(of.bodies[row], of.ends[2 * row]),
                   of.links[row - 1].value);
            first = speed_of<HasTurn>(of.bodies[row], of.ends[2 * row + 1]);
        }
        write_ends(first, strand_pack.after, arrays);
    }
}
HH_INLINE void evaluate_strand_velocities(const TriadArrays& arrays) {
    arrays.has_turn ? evaluate_strand_velocities<true>(arrays)
                    : evaluate_strand_velocities<false>(arrays);
}

HH_INLINE double worst_strand_square(const TriadArrays& arrays) {
    Double4 worst = zero4();
    for (const Links4& links : arrays.links) {
        worst = larger(worst, dot(links.value, links.value));
    }
    return largest(worst);
}

HH_INLINE void gather_strand_stiffness(const TriadArrays& arrays) {
    const Double4 zero = zero4();
    const std::span<const TriadPlan::StrandPack> strand_packs = arrays.plan->strand_packs();
    for (std::size_t i = 0; i < strand_packs.size(); ++i) {
        const TriadPlan::StrandPack& strand_pack = strand_packs[i];
        const StrandPackArrays of = part_of(strand_pack, arrays);
        for (std::size_t row = arrays.windows[i].begin; row < arrays.windows[i].end; ++row) {
            WideSymmetric sum{zero, zero, zero, zero, zero, zero};
            add_positive_stiffness(of.multipliers[row], of.ends[2 * row].arm, sum);
            add_positive_stiffness(of.multipliers[row + 1], of.ends[2 * row + 1].arm, sum);
            assign(sum, arrays.stiffness[strand_pack.row + row]);
        }
    }
}

// --- J W J^T and the factor --------------------------------------------------------------------

// Contribution of a row's bodies to the blocks of their two nodes.
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
    Wide3 diagonal;  // of the link eliminated last, before its elimination
    Double4 inverse_sum;
};

// Eliminates one link of each of four strands. `of_first`: contribution of the links' first bodies
// to their blocks; at.row: contribution of their second bodies.
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

// Eliminates each link as soon as both its bodies have contributed, so that the next row's product
// overlaps with the latency of the link's inverse. Returns the first step that is not coupled with
// `before`.
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
    // All inertias first, so that their latencies overlap.
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

// Adds the coupling of `before` with `after` to its block. A block's rows are those of the node
// that is eliminated first, so some lanes need the transpose.
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

// Applies the contributions of the eliminated strands to the blocks of the other nodes.
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

// --- Substitution ------------------------------------------------------------------------------

HH_INLINE void subtract_lambdas(const Wide3& v, const TriadPlan::Lanes& ends,
                                const TriadArrays& arrays) {
    const Wide4 rows = to_rows(v);
    arrays.lambdas[ends[0] / 2].v -= rows.x;
    arrays.lambdas[ends[1] / 2].v -= rows.y;
    arrays.lambdas[ends[2] / 2].v -= rows.z;
    arrays.lambdas[ends[3] / 2].v -= rows.w;
}

HH_INLINE Wide3 substitute_into(Links4& links, const Wide3& of_next) {
    const Wide3 own = (zero_wide3() - links.value) - of_next;
    assign(apply_inverse(links, own), links.unknown);
    return own;
}
HH_INLINE void substitute_into_strands(const TriadArrays& arrays) {
    const std::span<const TriadPlan::StrandPack> strand_packs = arrays.plan->strand_packs();
    for (std::size_t i = 0; i < strand_packs.size(); ++i) {
        const StrandPackRange part = part_in(arrays.windows[i], strand_packs[i]);
        Links4* const links = arrays.links.data() + strand_packs[i].step;
        Wide3 of_next = zero_wide3();
        Wide3 of_before = zero_wide3();
        std::size_t k = part.first_step;
        for (; k < arrays.strands[i].decoupled_step; ++k) {
            const Wide3 own = substitute_into(links[k], of_next);
            of_next = combine(links[k].next, own);
            of_before = of_before + combine(links[k].before, own);
        }
        for (; k < part.end_step; ++k) {
            of_next = combine(links[k].next, substitute_into(links[k], of_next));
        }
        subtract_lambdas(of_before, strand_packs[i].before, arrays);
        subtract_lambdas(of_next, strand_packs[i].after, arrays);
    }
}

HH_INLINE void substitute_back_into_strands(const TriadArrays& arrays) {
    const std::span<const TriadPlan::StrandPack> strand_packs = arrays.plan->strand_packs();
    for (std::size_t i = 0; i < strand_packs.size(); ++i) {
        const TriadPlan::StrandPack& strand_pack = strand_packs[i];
        const StrandPackRange part = part_in(arrays.windows[i], strand_pack);
        const StrandPackArrays of = part_of(strand_pack, arrays);
        const Wide3 before = lambdas_of(strand_pack.before, arrays);
        Wide3 own = lambdas_of(strand_pack.after, arrays);
        assign(before, of.multipliers[0]);
        assign(own, of.multipliers[strand_pack.length + 1]);
        const std::size_t decoupled = arrays.strands[i].decoupled_step;
        std::size_t k = part.end_step;
        for (; k > decoupled; --k) {
            const Links4& links = of.links[k - 1];
            own = links.unknown - multiply(links.next, own);
            assign(own, of.multipliers[k]);
        }
        for (; k > part.first_step; --k) {
            const Links4& links = of.links[k - 1];
            own = (links.unknown - multiply(links.before, before)) - multiply(links.next, own);
            assign(own, of.multipliers[k]);
        }
    }
}

HH_INLINE LargestMove gather_strand_moves(const TriadArrays& arrays) {
    WideLargestMove reach;
    const std::span<const TriadPlan::StrandPack> strand_packs = arrays.plan->strand_packs();
    for (std::size_t i = 0; i < strand_packs.size(); ++i) {
        const StrandPackArrays of = part_of(strand_packs[i], arrays);
        for (std::size_t row = arrays.windows[i].begin; row < arrays.windows[i].end; ++row) {
            WideWrench wrench{zero_wide3(), zero_wide3()};
            add_end(of.ends[2 * row], of.multipliers[row], arrays.has_turn, wrench);
            add_end(of.ends[2 * row + 1], of.multipliers[row + 1], arrays.has_turn, wrench);
            take_moves(wrench, of.bodies[row], reach);
        }
    }
    return {largest(reach.move), largest(reach.turn)};
}

HH_INLINE void apply_strands(const TriadArrays& arrays, double scale) {
    const std::span<const TriadPlan::StrandPack> strand_packs = arrays.plan->strand_packs();
    for (std::size_t i = 0; i < strand_packs.size(); ++i) {
        const StrandPackArrays of = part_of(strand_packs[i], arrays);
        for (std::size_t row = arrays.windows[i].begin; row < arrays.windows[i].end; ++row) {
            move_by(scale, of.bodies[row]);
        }
    }
}

}  // namespace handhold::triads

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
    Bodies4* bodies;  // indexed by row
    Ends4* ends;  // [2 * row]: the row's ends of the link before; [2 * row + 1]: of the link after
    Links4* links;       // indexed by step
    Wide3* multipliers;  // one for `before`, one per step, one for `after`
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

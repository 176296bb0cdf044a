// Solver, packed: kernels over four bodies at a time: poses, ends, inertia, J W J^T, moves.
// Included by triad_kernels.cpp only, and inlined there into functions for one processor type.

#pragma once

#include "engine/math/wide_rotation.hpp"
#include "engine/solver/model/geometric_stiffness.hpp"
#include "engine/solver/packed/triad_kernels.hpp"

namespace handhold::triads {

// --- Poses and ends ----------------------------------------------------------------------------

HH_INLINE Wide3 zero_wide3() { return {zero4(), zero4(), zero4()}; }

HH_INLINE void write_ends(const Wide3& parts, const TriadPlan::Lanes& lanes,
                          const TriadArrays& arrays) {
    const Wide4 rows = to_rows(parts);
    arrays.ends[lanes[0]].v = rows.x;
    arrays.ends[lanes[1]].v = rows.y;
    arrays.ends[lanes[2]].v = rows.z;
    arrays.ends[lanes[3]].v = rows.w;
}

HH_INLINE void add_up_ends(const TriadArrays& arrays) {
    for (std::size_t i = 0; i < arrays.values.size(); ++i) {
        arrays.values[i].v = arrays.ends[2 * i].v + arrays.ends[2 * i + 1].v;
    }
}

HH_INLINE void write_axes(Bodies4& bodies) {
    const WideAxes axes = axes_of(bodies.rotation);
    assign(axes.x, bodies.axes.x);
    assign(axes.y, bodies.axes.y);
    assign(axes.z, bodies.axes.z);
}
// Contribution of four ends to the residuals of their triads. Also updates the ends' arms.
HH_INLINE Wide3 part_of(const Bodies4& bodies, Ends4& end) {
    const Wide3 arm = rotate(bodies.axes, end.point_bs);
    assign(arm, end.arm);
    return end.sign * bodies.position + arm;
}

HH_INLINE void evaluate(const TriadArrays& arrays) {
    const std::span<const TriadPlan::Group> groups = arrays.plan->groups();
    for (std::size_t i = 0; i < groups.size(); ++i) {
        Bodies4& bodies = arrays.bodies[groups[i].group_index];
        write_axes(bodies);
        for (std::uint32_t j = 0; j < groups[i].width; ++j) {
            Ends4& ends = arrays.body_ends[groups[i].packed + j];
            write_ends(part_of(bodies, ends), arrays.plan->ends()[groups[i].ends + j], arrays);
        }
    }
    add_up_ends(arrays);
}

template <bool HasTurn>
HH_INLINE Wide3 speed_of(const Bodies4& bodies, const Ends4& end) {
    const Wide3 speed = end.sign * bodies.velocity + cross(bodies.spin, end.arm);
    return HasTurn ? speed + end.lever * bodies.spin : speed;
}

template <bool HasTurn>
HH_INLINE void evaluate_velocities(const TriadArrays& arrays) {
    const std::span<const TriadPlan::Group> groups = arrays.plan->groups();
    for (std::size_t i = 0; i < groups.size(); ++i) {
        const Bodies4& bodies = arrays.bodies[groups[i].group_index];
        for (std::uint32_t j = 0; j < groups[i].width; ++j) {
            write_ends(speed_of<HasTurn>(bodies, arrays.body_ends[groups[i].packed + j]),
                       arrays.plan->ends()[groups[i].ends + j], arrays);
        }
    }
    add_up_ends(arrays);
}
HH_INLINE void evaluate_velocities(const TriadArrays& arrays) {
    arrays.has_turn ? evaluate_velocities<true>(arrays) : evaluate_velocities<false>(arrays);
}

HH_INLINE double worst_square(const TriadArrays& arrays) {
    const std::span<const TriadVector> values = arrays.values;
    Double4 worst = zero4();
    std::size_t i = 0;
    for (; i + 4 <= values.size(); i += 4) {
        const Wide3 four = to_wide3(values[i].v, values[i + 1].v, values[i + 2].v, values[i + 3].v);
        worst = larger(worst, dot(four, four));
    }
    double rest = largest(worst);
    for (; i < values.size(); ++i) {
        const double square = dot3(values[i].v, values[i].v);
        rest = square > rest ? square : rest;
    }
    return rest;
}

// --- Inertia -----------------------------------------------------------------------------------

// Converts a diagonal matrix from body axes to world axes.
HH_INLINE WideSymmetric to_world(const WideAxes& axes, const Wide3& diagonal) {
    const Wide3 x = diagonal.x * axes.x;
    const Wide3 y = diagonal.y * axes.y;
    const Wide3 z = diagonal.z * axes.z;
    return {(axes.x.x * x.x + axes.y.x * y.x) + axes.z.x * z.x,
            (axes.x.y * x.y + axes.y.y * y.y) + axes.z.y * z.y,
            (axes.x.z * x.z + axes.y.z * y.z) + axes.z.z * z.z,
            (axes.x.x * x.y + axes.y.x * y.y) + axes.z.x * z.y,
            (axes.x.x * x.z + axes.y.x * y.z) + axes.z.x * z.z,
            (axes.x.y * x.z + axes.y.y * y.z) + axes.z.y * z.z};
}

HH_INLINE WideSymmetric inverse_of(const WideSymmetric& m, const Double4& times) {
    const Double4 xx = m.yy * m.zz - m.yz * m.yz;
    const Double4 xy = m.xz * m.yz - m.xy * m.zz;
    const Double4 xz = m.xy * m.yz - m.xz * m.yy;
    const Double4 factor = times / ((m.xx * xx + m.xy * xy) + m.xz * xz);
    return {factor * xx,
            factor * (m.xx * m.zz - m.xz * m.xz),
            factor * (m.xx * m.yy - m.xy * m.xy),
            factor * xy,
            factor * xz,
            factor * (m.xy * m.xz - m.xx * m.yz)};
}

// (I + stiffness)^-1; I: inertia in world axes. 0 if the body cannot rotate. Both terms are first
// multiplied by the product of the inverse moments, which takes one division at the end instead of
// three at the start.
HH_INLINE WideSymmetric inverse_with_stiffness(const Bodies4& bodies,
                                               const WideSymmetric& stiffness) {
    const Wide3& in = bodies.inverse_inertia_bs;
    const Mask4 may_turn = ((in.x + in.y) + in.z) > 0.0;
    const Double4 yz = in.y * in.z;
    const Double4 scale = in.x * yz;
    const WideSymmetric m = to_world(bodies.axes, {yz, in.x * in.z, in.x * in.y});
    const WideSymmetric inverse = inverse_of(
        {m.xx + scale * stiffness.xx, m.yy + scale * stiffness.yy, m.zz + scale * stiffness.zz,
         m.xy + scale * stiffness.xy, m.xz + scale * stiffness.xz, m.yz + scale * stiffness.yz},
        scale);
    const Double4 zero = zero4();
    return {may_turn ? inverse.xx : zero, may_turn ? inverse.yy : zero,
            may_turn ? inverse.zz : zero, may_turn ? inverse.xy : zero,
            may_turn ? inverse.xz : zero, may_turn ? inverse.yz : zero};
}

HH_INLINE Wide3 lambdas_of(const TriadPlan::Lanes& ends, const TriadArrays& arrays) {
    return to_wide3(arrays.lambdas[ends[0] / 2].v, arrays.lambdas[ends[1] / 2].v,
                    arrays.lambdas[ends[2] / 2].v, arrays.lambdas[ends[3] / 2].v);
}

HH_INLINE void gather_stiffness(const TriadArrays& arrays) {
    const std::span<const TriadPlan::Group> groups = arrays.plan->groups();
    const Double4 zero = zero4();
    for (std::size_t i = 0; i < groups.size(); ++i) {
        WideSymmetric sum{zero, zero, zero, zero, zero, zero};
        for (std::uint32_t j = 0; j < groups[i].width; ++j) {
            add_positive_stiffness(lambdas_of(arrays.plan->ends()[groups[i].ends + j], arrays),
                                   arrays.body_ends[groups[i].packed + j].arm, sum);
        }
        assign(sum, arrays.stiffness[groups[i].group_index]);
    }
}

// --- J W J^T -----------------------------------------------------------------------------------

HH_INLINE void write_row(const Wide3& row, const TriadPlan::Pair& pair, int place,
                         const TriadArrays& arrays) {
    const Wide4 rows = to_rows(row);
    Double4& a = arrays.blocks[pair.blocks[0]].row[place];
    Double4& b = arrays.blocks[pair.blocks[1]].row[place];
    Double4& c = arrays.blocks[pair.blocks[2]].row[place];
    Double4& d = arrays.blocks[pair.blocks[3]].row[place];
    if (pair.is_alone) {
        a = rows.x;
        b = rows.y;
        c = rows.z;
        d = rows.w;
    } else {
        a += rows.x;
        b += rows.y;
        c += rows.z;
        d += rows.w;
    }
}

// Rotational part of J W at one end, three rows. The rows of J are arm x e_k (point triads) or
// lever * e_k (angular triads); e_k: unit vector along world axis k.
template <bool HasTurn>
HH_INLINE void write_side(const WideSymmetric& w, const Ends4& end, Wide3* side) {
    const Wide3 x{w.xx, w.xy, w.xz};
    const Wide3 y{w.xy, w.yy, w.yz};
    const Wide3 z{w.xz, w.yz, w.zz};
    side[0] = end.arm.z * y - end.arm.y * z;
    side[1] = end.arm.x * z - end.arm.z * x;
    side[2] = end.arm.y * x - end.arm.x * y;
    if (HasTurn) {
        side[0] = side[0] + end.lever * x;
        side[1] = side[1] + end.lever * y;
        side[2] = side[2] + end.lever * z;
    }
}
template <bool HasTurn>
HH_INLINE Wide3 times_end(const Wide3& side, const Ends4& end) {
    const Wide3 product = cross(side, end.arm);
    return HasTurn ? product + end.lever * side : product;
}

template <bool HasTurn>
HH_INLINE void multiply_out_group(const Bodies4& bodies, const TriadPlan::Group& group,
                                  const TriadArrays& arrays) {
    const TriadPlan::Pair* pair = arrays.plan->pairs().data() + group.pairs;
    const Ends4* const ends = arrays.body_ends.data() + group.packed;
    for (std::uint32_t i = 0; i < group.width; ++i) {
        Wide3 side[3];
        write_side<HasTurn>(bodies.inverse_inertia, ends[i], side);
        const Double4 mass = bodies.inverse_mass * ends[i].sign;
        for (std::uint32_t j = i; j < group.width; ++j) {
            const Double4 shared = mass * ends[j].sign;
            Wide3 x = times_end<HasTurn>(side[0], ends[j]);
            Wide3 y = times_end<HasTurn>(side[1], ends[j]);
            Wide3 z = times_end<HasTurn>(side[2], ends[j]);
            x.x += shared;
            y.y += shared;
            z.z += shared;
            write_row(x, *pair, 0, arrays);
            write_row(y, *pair, 1, arrays);
            write_row(z, *pair, 2, arrays);
            ++pair;
        }
    }
}

HH_INLINE void write_inertia(std::size_t group, const TriadArrays& arrays) {
    Bodies4& bodies = arrays.bodies[group];
    if (arrays.has_stiffness) {
        assign(inverse_with_stiffness(bodies, arrays.stiffness[group]), bodies.inverse_inertia);
    } else {
        assign(to_world(bodies.axes, bodies.inverse_inertia_bs), bodies.inverse_inertia);
    }
}

HH_INLINE void multiply_out(const TriadArrays& arrays) {
    for (const std::uint32_t zero : arrays.plan->zeros()) {
        Rows3& block = arrays.blocks[zero];
        block.row[0] = zero4();
        block.row[1] = zero4();
        block.row[2] = zero4();
    }
    const std::span<const TriadPlan::Group> groups = arrays.plan->groups();
    for (std::size_t i = 0; i < groups.size(); ++i) {
        Bodies4& bodies = arrays.bodies[groups[i].group_index];
        write_inertia(groups[i].group_index, arrays);
        if (arrays.has_turn) {
            multiply_out_group<true>(bodies, groups[i], arrays);
        } else {
            multiply_out_group<false>(bodies, groups[i], arrays);
        }
    }
}

// --- Moves -------------------------------------------------------------------------------------

struct WideWrench {
    Wide3 impulse, couple;
};

HH_INLINE void add_end(const Ends4& end, const Wide3& lambda, bool has_turn, WideWrench& out) {
    out.impulse = out.impulse + end.sign * lambda;
    out.couple = out.couple + cross(end.arm, lambda);
    if (has_turn) {
        out.couple = out.couple + end.lever * lambda;
    }
}

struct WideLargestMove {
    Double4 move = zero4();
    Double4 turn = zero4();
};

HH_INLINE void take_moves(const WideWrench& wrench, Bodies4& bodies, WideLargestMove& reach) {
    const Wide3 move = bodies.inverse_mass * wrench.impulse;
    const Wide3 turn = multiply(bodies.inverse_inertia, wrench.couple);
    assign(move, bodies.move);
    assign(turn, bodies.turn);
    reach.move = larger(reach.move, dot(move, move));
    reach.turn = larger(reach.turn, dot(turn, turn));
}

// Computes the bodies' moves W J^T lambda. Returns the largest.
HH_INLINE LargestMove gather_moves(const TriadArrays& arrays) {
    const std::span<const TriadPlan::Group> groups = arrays.plan->groups();
    WideLargestMove reach;
    for (std::size_t i = 0; i < groups.size(); ++i) {
        WideWrench wrench{zero_wide3(), zero_wide3()};
        for (std::uint32_t j = 0; j < groups[i].width; ++j) {
            add_end(arrays.body_ends[groups[i].packed + j],
                    lambdas_of(arrays.plan->ends()[groups[i].ends + j], arrays), arrays.has_turn,
                    wrench);
        }
        take_moves(wrench, arrays.bodies[groups[i].group_index], reach);
    }
    return {largest(reach.move), largest(reach.turn)};
}

HH_INLINE LargestMove longer(const LargestMove& a, const LargestMove& b) {
    return {a.move_square > b.move_square ? a.move_square : b.move_square,
            a.turn_square > b.turn_square ? a.turn_square : b.turn_square};
}

// Cayley map: a rotation by 2 atan(|turn| / 2), to second order equal to the exponential map. Lanes
// without rotation keep their bits.
HH_INLINE void turn_by(const Wide3& turn, Wide4& rotation) {
    const Double4 half = zero4() + 0.5;
    const Wide4 after = turned(half * turn, zero4() + 1.0, rotation);
    const Mask4 turns = dot(turn, turn) > 0.0;
    rotation.x = turns ? after.x : rotation.x;
    rotation.y = turns ? after.y : rotation.y;
    rotation.z = turns ? after.z : rotation.z;
    rotation.w = turns ? after.w : rotation.w;
}

HH_INLINE void move_by(double scale, Bodies4& bodies) {
    const Double4 by = zero4() + scale;
    assign(bodies.position + by * bodies.move, bodies.position);
    turn_by(by * bodies.turn, bodies.rotation);
}
HH_INLINE void apply(const TriadArrays& arrays, double scale) {
    for (const TriadPlan::Group& group : arrays.plan->groups()) {
        move_by(scale, arrays.bodies[group.group_index]);
    }
}

HH_INLINE void apply_velocities(const TriadArrays& arrays) {
    for (Bodies4& bodies : arrays.bodies) {
        assign(bodies.velocity + bodies.move, bodies.velocity);
        assign(bodies.spin + bodies.turn, bodies.spin);
    }
}

}  // namespace handhold::triads

// Sources: LDL^T by blocks as in Golub and Van Loan, Matrix Computations, 4.2.
#include "engine/solver/triad_kernels.hpp"

#include <algorithm>
#include <cmath>

#include "engine/solver/rows.hpp"

namespace handhold {
namespace {

HH_INLINE Rows3 axes_of(const Four& rotation) {
    const double x = rotation[0];
    const double y = rotation[1];
    const double z = rotation[2];
    const double w = rotation[3];
    const double x2 = x + x;
    const double y2 = y + y;
    const double z2 = z + z;
    return {{Four{1.0 - (y2 * y + z2 * z), x2 * y + z2 * w, x2 * z - y2 * w, 0.0},
             Four{x2 * y - z2 * w, 1.0 - (x2 * x + z2 * z), y2 * z + x2 * w, 0.0},
             Four{x2 * z + y2 * w, y2 * z - x2 * w, 1.0 - (x2 * x + y2 * y), 0.0}}};
}

HH_INLINE void evaluate(const TriadArrays& arrays) {
    for (TriadBody& body : arrays.bodies.first(arrays.moving)) {
        body.axes = axes_of(body.rotation);
    }
    for (std::size_t i = 0; i < arrays.triads.size(); ++i) {
        const Triad& triad = arrays.triads[i];
        if (triad.turns) {
            continue;
        }
        const TriadBody& a = arrays.bodies[triad.bodies[0]];
        const TriadBody& b = arrays.bodies[triad.bodies[1]];
        const Four arm_a = combine(a.axes, triad.points[0]);
        const Four arm_b = -combine(b.axes, triad.points[1]);
        arrays.arms[2 * i].v = arm_a;
        arrays.arms[2 * i + 1].v = arm_b;
        arrays.values[i].v = (a.position - b.position) + (arm_a + arm_b);
    }
}

HH_INLINE void evaluate_velocities(const TriadArrays& arrays) {
    for (std::size_t i = 0; i < arrays.triads.size(); ++i) {
        const Triad& triad = arrays.triads[i];
        const TriadBody& a = arrays.bodies[triad.bodies[0]];
        const TriadBody& b = arrays.bodies[triad.bodies[1]];
        if (triad.turns) {
            arrays.values[i].v = k_angle_m * (a.spin - b.spin);
        } else {
            arrays.values[i].v =
                (a.velocity - b.velocity) +
                (cross(a.spin, arrays.arms[2 * i].v) + cross(b.spin, arrays.arms[2 * i + 1].v));
        }
    }
}

// A diagonal matrix in a body's axes, in the world's.
HH_INLINE Rows3 to_world(const Rows3& axes, const Four& diagonal) {
    const Rows3 scaled{
        {axes.row[0] * diagonal[0], axes.row[1] * diagonal[1], axes.row[2] * diagonal[2]}};
    Rows3 out;
    for (int i = 0; i < 3; ++i) {
        out.row[i] = (axes.row[0] * scaled.row[0][i] + axes.row[1] * scaled.row[1][i]) +
                     axes.row[2] * scaled.row[2][i];
    }
    return out;
}

HH_INLINE void write_inertia(const TriadArrays& arrays) {
    for (TriadBody& body : arrays.bodies.first(arrays.moving)) {
        if (body.may_turn) {
            body.inverse_inertia = to_world(body.axes, body.inverse_inertia_bs);
        }
    }
}

// += factor v v^T
HH_INLINE void add_outer(const Four& v, double factor, Rows3& out) {
    const Four scaled = factor * v;
    for (int i = 0; i < 3; ++i) {
        out.row[i] += scaled * v[i];
    }
}

// positive_stiffness of a force and an arm, or of a negative one with its sign.
HH_INLINE void add_stiffness(const Four& force, const Four& arm, Rows3& out) {
    constexpr double k_least = 1e-12;
    const double force_square = dot3(force, force);
    const double arm_square = dot3(arm, arm);
    const double product = std::sqrt(force_square * arm_square);
    if (!(product >= k_least)) {
        return;
    }
    const double along = dot3(force, arm);
    const Four normal = cross(force, arm);
    const double normal_square = dot3(normal, normal);
    if (along > 0.0 && normal_square <= k_least * product * product) {
        out.row[0] += Four{product, 0.0, 0.0, 0.0};
        out.row[1] += Four{0.0, product, 0.0, 0.0};
        out.row[2] += Four{0.0, 0.0, product, 0.0};
        add_outer(force, -product / force_square, out);
        return;
    }
    const Four axis = force - (product / arm_square) * arm;
    add_outer(axis, 0.5 * (product + along) / dot3(axis, axis), out);
    if (along > 0.0) {
        add_outer(normal, along / normal_square, out);
    }
}

HH_INLINE void gather_stiffness(const TriadArrays& arrays) {
    std::ranges::fill(arrays.stiffness, Rows3{});
    for (std::size_t i = 0; i < arrays.triads.size(); ++i) {
        if (arrays.triads[i].turns) {
            continue;
        }
        for (std::size_t side = 0; side < 2; ++side) {
            const std::uint32_t body = arrays.triads[i].bodies[side];
            if (arrays.bodies[body].may_turn) {
                add_stiffness(arrays.lambdas[i].v, arrays.arms[2 * i + side].v,
                              arrays.stiffness[body]);
            }
        }
    }
}

HH_INLINE Rows3 times(double factor, const Rows3& m) {
    return {{factor * m.row[0], factor * m.row[1], factor * m.row[2]}};
}

// Of a symmetric matrix.
HH_INLINE Rows3 inverse_of(const Rows3& m) {
    const Rows3 cofactors{
        {cross(m.row[1], m.row[2]), cross(m.row[2], m.row[0]), cross(m.row[0], m.row[1])}};
    const double factor = 1.0 / dot3(m.row[0], cofactors.row[0]);
    return times(factor, cofactors);
}

HH_INLINE void write_stiff_inertia(const TriadArrays& arrays) {
    for (std::size_t i = 0; i < arrays.moving; ++i) {
        TriadBody& body = arrays.bodies[i];
        if (!body.may_turn) {
            continue;
        }
        const Four inertia_bs = 1.0 / (body.inverse_inertia_bs + Four{0.0, 0.0, 0.0, 1.0});
        Rows3 inertia = to_world(body.axes, inertia_bs);
        for (int row = 0; row < 3; ++row) {
            inertia.row[row] += arrays.stiffness[i].row[row];
        }
        body.inverse_inertia = inverse_of(inertia);
    }
}

// A rotation's rows are the axes, at a lever that is negative for b.
HH_INLINE double lever_of(std::size_t end) { return end % 2 == 0 ? k_angle_m : -k_angle_m; }

// J W of one end of a triad, the rotation's part. J's rows are arm x e_k.
HH_INLINE Rows3 side_of(const Rows3& inverse_inertia, const Four& arm) {
    const Rows3& in = inverse_inertia;
    return {{in.row[1] * arm[2] - in.row[2] * arm[1], in.row[2] * arm[0] - in.row[0] * arm[2],
             in.row[0] * arm[1] - in.row[1] * arm[0]}};
}

template <bool HasTurn>
HH_INLINE void write_sides(const TriadArrays& arrays) {
    for (std::size_t end = 0; end < 2 * arrays.triads.size(); ++end) {
        const Triad& triad = arrays.triads[end / 2];
        const Rows3& inverse_inertia = arrays.bodies[triad.bodies[end % 2]].inverse_inertia;
        arrays.sides[end] = HasTurn && triad.turns ? times(lever_of(end), inverse_inertia)
                                                   : side_of(inverse_inertia, arrays.arms[end].v);
    }
}

// The rotation's part of J W J^T: += side J^T, by rows. They stay in registers: of a struct GCC
// makes copies in memory.
template <bool HasTurn>
HH_INLINE void add_product(const TriadArrays& arrays, const TriadPlan::Coupling& coupling, Four& x,
                           Four& y, Four& z) {
    const Rows3& side = arrays.sides[coupling.row_end];
    const std::uint32_t column = coupling.column_end;
    if (HasTurn && arrays.triads[column / 2].turns) {
        const double lever = lever_of(column);
        x += lever * side.row[0];
        y += lever * side.row[1];
        z += lever * side.row[2];
        return;
    }
    const Four arm = arrays.arms[column].v;
    x += cross(side.row[0], arm);
    y += cross(side.row[1], arm);
    z += cross(side.row[2], arm);
}
HH_INLINE void write_rows(const Four& x, const Four& y, const Four& z, Rows3& out) {
    out.row[0] = x;
    out.row[1] = y;
    out.row[2] = z;
}

template <bool HasTurn>
HH_INLINE void multiply_out(const TriadArrays& arrays) {
    write_sides<HasTurn>(arrays);
    for (const std::uint32_t block : arrays.plan->fill_in()) {
        write_rows(zero_four(), zero_four(), zero_four(), arrays.blocks[block]);
    }
    const TriadPlan::Coupling* coupling = arrays.plan->couplings().data();
    const double* mass = arrays.masses.data();
    std::uint32_t begin = 0;
    for (const TriadPlan::Sum& sum : arrays.plan->sums()) {
        Four x = {*mass, 0.0, 0.0, 0.0};
        Four y = {0.0, *mass, 0.0, 0.0};
        Four z = {0.0, 0.0, *mass, 0.0};
        for (++mass; begin < sum.end; ++begin) {
            add_product<HasTurn>(arrays, *coupling++, x, y, z);
        }
        write_rows(x, y, z, arrays.blocks[sum.target]);
    }
}
HH_INLINE void multiply_out(const TriadArrays& arrays) {
    arrays.has_turn ? multiply_out<true>(arrays) : multiply_out<false>(arrays);
}

HH_INLINE double inverse_pivot(double pivot, double least) {
    return std::abs(pivot) > least ? 1.0 / pivot : 0.0;
}

// Of the block with alpha on its diagonal. Only what lies on and below the diagonal counts.
HH_INLINE TriadPivots decompose(const Rows3& block, const Four& diagonal, const Four& alpha) {
    const Four least = k_smallest_pivot * diagonal;
    const double d10 = block.row[1][0];
    const double d20 = block.row[2][0];
    TriadPivots p;
    p.inverse[0] = inverse_pivot(block.row[0][0] + alpha[0], least[0]);
    p.l10 = d10 * p.inverse[0];
    p.l20 = d20 * p.inverse[0];
    p.inverse[1] = inverse_pivot((block.row[1][1] + alpha[1]) - p.l10 * d10, least[1]);
    const double rest = block.row[2][1] - p.l20 * d10;
    p.l21 = rest * p.inverse[1];
    p.inverse[2] =
        inverse_pivot(((block.row[2][2] + alpha[2]) - p.l20 * d20) - p.l21 * rest, least[2]);
    return p;
}

// The block's inverse times m.
HH_INLINE Rows3 divide(const TriadPivots& p, const Rows3& m) {
    const Four y1 = m.row[1] - m.row[0] * p.l10;
    const Four y2 = (m.row[2] - m.row[0] * p.l20) - y1 * p.l21;
    const Four x2 = y2 * p.inverse[2];
    const Four x1 = y1 * p.inverse[1] - x2 * p.l21;
    const Four x0 = (m.row[0] * p.inverse[0] - x2 * p.l20) - x1 * p.l10;
    return {{x0, x1, x2}};
}
HH_INLINE Four divide(const TriadPivots& p, const Four& v) {
    const double y1 = v[1] - v[0] * p.l10;
    const double y2 = (v[2] - v[0] * p.l20) - y1 * p.l21;
    const double x2 = y2 * p.inverse[2];
    const double x1 = y1 * p.inverse[1] - x2 * p.l21;
    const double x0 = (v[0] * p.inverse[0] - x2 * p.l20) - x1 * p.l10;
    return Four{x0, x1, x2, 0.0};
}

// out -= carried^T tied.
HH_INLINE void subtract_product(const Rows3& carried, const Rows3& tied, Rows3& out) {
    for (int i = 0; i < 3; ++i) {
        out.row[i] -= (tied.row[0] * carried.row[0][i] + tied.row[1] * carried.row[1][i]) +
                      tied.row[2] * carried.row[2][i];
    }
}

HH_INLINE void factorise(const TriadArrays& arrays, double hand_alpha, double joint_alpha) {
    const TriadPlan& plan = *arrays.plan;
    const std::span<const TriadPlan::Step> steps = plan.steps();
    // Pivots are compared with the diagonal before others take their share of it.
    for (std::size_t i = 0; i < steps.size(); ++i) {
        const Rows3& block = arrays.blocks[steps[i].own];
        arrays.unknowns[i].v = Four{block.row[0][0], block.row[1][1], block.row[2][2], 0.0};
    }
    for (std::size_t i = 0; i < steps.size(); ++i) {
        const TriadPlan::Step& step = steps[i];
        const Four diagonal = arrays.unknowns[i].v;
        const Four alpha =
            arrays.triads[step.node].is_hand
                ? Four{diagonal[0] > 0.0 ? hand_alpha : 0.0, diagonal[1] > 0.0 ? hand_alpha : 0.0,
                       diagonal[2] > 0.0 ? hand_alpha : 0.0, 0.0}
                : joint_alpha * diagonal;
        const TriadPivots pivots = decompose(arrays.blocks[step.own], diagonal, alpha);
        arrays.pivots[i] = pivots;
        const std::uint32_t count = step.later_end - step.later_begin;
        const std::uint32_t* target = plan.updates().data() + step.updates;
        Rows3* const tied = arrays.blocks.data() + step.own + 1;
        for (std::uint32_t x = 0; x < count; ++x) {
            const Rows3 carried = divide(pivots, tied[x]);
            for (std::uint32_t y = x; y < count; ++y) {
                subtract_product(carried, tied[y], arrays.blocks[*target++]);
            }
            tied[x] = carried;
        }
    }
}

HH_INLINE void substitute(const TriadArrays& arrays) {
    const TriadPlan& plan = *arrays.plan;
    const std::span<const TriadPlan::Step> steps = plan.steps();
    for (std::size_t i = 0; i < steps.size(); ++i) {
        const Four own = arrays.lambdas[steps[i].node].v;
        const Rows3* carried = arrays.blocks.data() + steps[i].own + 1;
        for (const std::uint32_t later : plan.later(steps[i])) {
            arrays.lambdas[later].v -= combine(*carried++, own);
        }
        arrays.unknowns[i].v = divide(arrays.pivots[i], own);
    }
    for (std::size_t i = steps.size(); i-- > 0;) {
        Four own = arrays.unknowns[i].v;
        const Rows3* carried = arrays.blocks.data() + steps[i].own + 1;
        for (const std::uint32_t later : plan.later(steps[i])) {
            own -= multiply(*carried++, arrays.lambdas[later].v);
        }
        arrays.lambdas[steps[i].node].v = own;
    }
}

HH_INLINE void gather_moves(const TriadArrays& arrays) {
    for (TriadBody& body : arrays.bodies) {
        body.move = body.turn = zero_four();
    }
    for (std::size_t i = 0; i < arrays.triads.size(); ++i) {
        TriadBody& a = arrays.bodies[arrays.triads[i].bodies[0]];
        TriadBody& b = arrays.bodies[arrays.triads[i].bodies[1]];
        const Four lambda = arrays.lambdas[i].v;
        if (arrays.triads[i].turns) {
            a.turn += k_angle_m * lambda;
            b.turn -= k_angle_m * lambda;
            continue;
        }
        a.move += lambda;
        b.move -= lambda;
        a.turn += cross(arrays.arms[2 * i].v, lambda);
        b.turn += cross(arrays.arms[2 * i + 1].v, lambda);
    }
    for (TriadBody& body : arrays.bodies.first(arrays.moving)) {
        body.move *= body.inverse_mass;
        body.turn = combine(body.inverse_inertia, body.turn);
    }
}

HH_INLINE void solve(const TriadArrays& arrays) {
    for (std::size_t i = 0; i < arrays.triads.size(); ++i) {
        arrays.lambdas[i].v = -arrays.values[i].v;
    }
    substitute(arrays);
    gather_moves(arrays);
}

// Cayley's map: a turn of 2 atan(|turn| / 2), as good a step as the exact one.
HH_INLINE Four turned(const Four& q, const Four& turn) {
    const Four half = 0.5 * turn;
    const Four product = (q + half * q[3]) + cross(half, q) - Four{0.0, 0.0, 0.0, dot3(half, q)};
    const Four square = product * product;
    return product / std::sqrt((square[0] + square[1]) + (square[2] + square[3]));
}

HH_INLINE void apply(const TriadArrays& arrays, double scale) {
    for (TriadBody& body : arrays.bodies.first(arrays.moving)) {
        if (body.inverse_mass > 0.0) {
            body.position += scale * body.move;
        }
        if (body.may_turn && dot3(body.turn, body.turn) > 0.0) {
            body.rotation = turned(body.rotation, scale * body.turn);
        }
    }
}

#ifdef __x86_64__
// Built for AVX2: no fused operations, so that the bits stay.
#define HH_AVX2 [[gnu::target("avx2")]]

HH_AVX2 void evaluate_avx2(const TriadArrays& arrays) { evaluate(arrays); }
HH_AVX2 void evaluate_velocities_avx2(const TriadArrays& arrays) { evaluate_velocities(arrays); }
HH_AVX2 void write_inertia_avx2(const TriadArrays& arrays) { write_inertia(arrays); }
HH_AVX2 void gather_stiffness_avx2(const TriadArrays& arrays) { gather_stiffness(arrays); }
HH_AVX2 void write_stiff_inertia_avx2(const TriadArrays& arrays) { write_stiff_inertia(arrays); }
HH_AVX2 void multiply_out_avx2(const TriadArrays& arrays) { multiply_out(arrays); }
HH_AVX2 void factorise_avx2(const TriadArrays& arrays, double hand_alpha, double joint_alpha) {
    factorise(arrays, hand_alpha, joint_alpha);
}
HH_AVX2 void solve_avx2(const TriadArrays& arrays) { solve(arrays); }
HH_AVX2 void apply_avx2(const TriadArrays& arrays, double scale) { apply(arrays, scale); }

constexpr TriadKernels k_avx2{evaluate_avx2,
                              evaluate_velocities_avx2,
                              gather_stiffness_avx2,
                              write_inertia_avx2,
                              write_stiff_inertia_avx2,
                              multiply_out_avx2,
                              factorise_avx2,
                              solve_avx2,
                              apply_avx2};
#endif

void evaluate_portable(const TriadArrays& arrays) { evaluate(arrays); }
void evaluate_velocities_portable(const TriadArrays& arrays) { evaluate_velocities(arrays); }
void write_inertia_portable(const TriadArrays& arrays) { write_inertia(arrays); }
void gather_stiffness_portable(const TriadArrays& arrays) { gather_stiffness(arrays); }
void write_stiff_inertia_portable(const TriadArrays& arrays) { write_stiff_inertia(arrays); }
void multiply_out_portable(const TriadArrays& arrays) { multiply_out(arrays); }
void factorise_portable(const TriadArrays& arrays, double hand_alpha, double joint_alpha) {
    factorise(arrays, hand_alpha, joint_alpha);
}
void solve_portable(const TriadArrays& arrays) { solve(arrays); }
void apply_portable(const TriadArrays& arrays, double scale) { apply(arrays, scale); }

constexpr TriadKernels k_portable{evaluate_portable,
                                  evaluate_velocities_portable,
                                  gather_stiffness_portable,
                                  write_inertia_portable,
                                  write_stiff_inertia_portable,
                                  multiply_out_portable,
                                  factorise_portable,
                                  solve_portable,
                                  apply_portable};

}  // namespace

const TriadKernels& triad_kernels() {
#ifdef __x86_64__
    static const bool has_avx2 = __builtin_cpu_supports("avx2") != 0;
    return has_avx2 ? k_avx2 : k_portable;
#else
    return k_portable;
#endif
}
const TriadKernels& portable_triad_kernels() { return k_portable; }

}  // namespace handhold

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
    for (Triad& triad : arrays.triads) {
        if (triad.turns) {
            continue;
        }
        const TriadBody& a = arrays.bodies[triad.bodies[0]];
        const TriadBody& b = arrays.bodies[triad.bodies[1]];
        triad.arms[0] = combine(a.axes, triad.points[0]);
        triad.arms[1] = -combine(b.axes, triad.points[1]);
        triad.value = (a.position - b.position) + (triad.arms[0] + triad.arms[1]);
    }
}

HH_INLINE void evaluate_velocities(const TriadArrays& arrays) {
    for (Triad& triad : arrays.triads) {
        const TriadBody& a = arrays.bodies[triad.bodies[0]];
        const TriadBody& b = arrays.bodies[triad.bodies[1]];
        if (triad.turns) {
            triad.value = k_angle_m * (a.spin - b.spin);
        } else {
            triad.value = (a.velocity - b.velocity) +
                          (cross(a.spin, triad.arms[0]) + cross(b.spin, triad.arms[1]));
        }
    }
}

HH_INLINE void write_inertia(const TriadArrays& arrays) {
    for (TriadBody& body : arrays.bodies.first(arrays.moving)) {
        if (!body.may_turn) {
            continue;
        }
        const Rows3& axes = body.axes;
        const Rows3 scaled{{axes.row[0] * body.inverse_inertia_bs[0],
                            axes.row[1] * body.inverse_inertia_bs[1],
                            axes.row[2] * body.inverse_inertia_bs[2]}};
        for (int i = 0; i < 3; ++i) {
            body.inverse_inertia.row[i] =
                (axes.row[0] * scaled.row[0][i] + axes.row[1] * scaled.row[1][i]) +
                axes.row[2] * scaled.row[2][i];
        }
    }
}

// J W of one side of a triad, the rotation's part. J's rows are arm x e_k.
HH_INLINE Rows3 side_of(const Triad& triad, std::size_t side, const Rows3& inverse_inertia) {
    const Rows3& in = inverse_inertia;
    if (triad.turns) {
        const double lever = side == 0 ? k_angle_m : -k_angle_m;
        return {{lever * in.row[0], lever * in.row[1], lever * in.row[2]}};
    }
    const Four arm = triad.arms[side];
    return {{in.row[1] * arm[2] - in.row[2] * arm[1], in.row[2] * arm[0] - in.row[0] * arm[2],
             in.row[0] * arm[1] - in.row[1] * arm[0]}};
}

// J W J^T of two triads in one body: += side J^T, and the mass that points share.
HH_INLINE void add_product(const Rows3& side, const Triad& row, const Triad& column,
                           std::uint32_t row_side, std::uint32_t column_side, double inverse_mass,
                           Rows3& out) {
    if (column.turns) {
        const double lever = column_side == 0 ? k_angle_m : -k_angle_m;
        for (int i = 0; i < 3; ++i) {
            out.row[i] += lever * side.row[i];
        }
        return;
    }
    const Four arm = column.arms[column_side];
    const double mass = row.turns ? 0.0 : row_side == column_side ? inverse_mass : -inverse_mass;
    out.row[0] += cross(side.row[0], arm) + Four{mass, 0.0, 0.0, 0.0};
    out.row[1] += cross(side.row[1], arm) + Four{0.0, mass, 0.0, 0.0};
    out.row[2] += cross(side.row[2], arm) + Four{0.0, 0.0, mass, 0.0};
}

HH_INLINE void multiply_out(const TriadArrays& arrays) {
    for (std::size_t i = 0; i < arrays.triads.size(); ++i) {
        const Triad& triad = arrays.triads[i];
        for (std::size_t side = 0; side < 2; ++side) {
            arrays.sides[2 * i + side] =
                side_of(triad, side, arrays.bodies[triad.bodies[side]].inverse_inertia);
        }
    }
    std::ranges::fill(arrays.blocks, Rows3{});
    for (const TriadPlan::Coupling& coupling : arrays.plan->couplings()) {
        const std::uint32_t row_side = coupling.row_end % 2;
        const Triad& row = arrays.triads[coupling.row_end / 2];
        add_product(arrays.sides[coupling.row_end], row, arrays.triads[coupling.column_end / 2],
                    row_side, coupling.column_end % 2,
                    arrays.bodies[row.bodies[row_side]].inverse_mass,
                    arrays.blocks[coupling.target]);
    }
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
        arrays.unknowns[i].vector = Four{block.row[0][0], block.row[1][1], block.row[2][2], 0.0};
    }
    for (std::size_t i = 0; i < steps.size(); ++i) {
        const TriadPlan::Step& step = steps[i];
        const Four diagonal = arrays.unknowns[i].vector;
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
        const Four own = arrays.triads[steps[i].node].lambda;
        const Rows3* carried = arrays.blocks.data() + steps[i].own + 1;
        for (const std::uint32_t later : plan.later(steps[i])) {
            arrays.triads[later].lambda -= combine(*carried++, own);
        }
        arrays.unknowns[i].vector = divide(arrays.pivots[i], own);
    }
    for (std::size_t i = steps.size(); i-- > 0;) {
        Four own = arrays.unknowns[i].vector;
        const Rows3* carried = arrays.blocks.data() + steps[i].own + 1;
        for (const std::uint32_t later : plan.later(steps[i])) {
            const Four& lambda = arrays.triads[later].lambda;
            own -= Four{dot3(carried->row[0], lambda), dot3(carried->row[1], lambda),
                        dot3(carried->row[2], lambda), 0.0};
            ++carried;
        }
        arrays.triads[steps[i].node].lambda = own;
    }
}

HH_INLINE void gather_moves(const TriadArrays& arrays) {
    for (TriadBody& body : arrays.bodies) {
        body.move = body.turn = zero_four();
    }
    for (const Triad& triad : arrays.triads) {
        TriadBody& a = arrays.bodies[triad.bodies[0]];
        TriadBody& b = arrays.bodies[triad.bodies[1]];
        if (triad.turns) {
            a.turn += k_angle_m * triad.lambda;
            b.turn -= k_angle_m * triad.lambda;
            continue;
        }
        a.move += triad.lambda;
        b.move -= triad.lambda;
        a.turn += cross(triad.arms[0], triad.lambda);
        b.turn += cross(triad.arms[1], triad.lambda);
    }
    for (TriadBody& body : arrays.bodies.first(arrays.moving)) {
        body.move *= body.inverse_mass;
        body.turn = combine(body.inverse_inertia, body.turn);
    }
}

HH_INLINE void solve(const TriadArrays& arrays) {
    for (Triad& triad : arrays.triads) {
        triad.lambda = -triad.value;
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
HH_AVX2 void multiply_out_avx2(const TriadArrays& arrays) { multiply_out(arrays); }
HH_AVX2 void factorise_avx2(const TriadArrays& arrays, double hand_alpha, double joint_alpha) {
    factorise(arrays, hand_alpha, joint_alpha);
}
HH_AVX2 void solve_avx2(const TriadArrays& arrays) { solve(arrays); }
HH_AVX2 void apply_avx2(const TriadArrays& arrays, double scale) { apply(arrays, scale); }

constexpr TriadKernels k_avx2{evaluate_avx2,     evaluate_velocities_avx2, write_inertia_avx2,
                              multiply_out_avx2, factorise_avx2,           solve_avx2,
                              apply_avx2};
#endif

void evaluate_portable(const TriadArrays& arrays) { evaluate(arrays); }
void evaluate_velocities_portable(const TriadArrays& arrays) { evaluate_velocities(arrays); }
void write_inertia_portable(const TriadArrays& arrays) { write_inertia(arrays); }
void multiply_out_portable(const TriadArrays& arrays) { multiply_out(arrays); }
void factorise_portable(const TriadArrays& arrays, double hand_alpha, double joint_alpha) {
    factorise(arrays, hand_alpha, joint_alpha);
}
void solve_portable(const TriadArrays& arrays) { solve(arrays); }
void apply_portable(const TriadArrays& arrays, double scale) { apply(arrays, scale); }

constexpr TriadKernels k_portable{evaluate_portable,      evaluate_velocities_portable,
                                  write_inertia_portable, multiply_out_portable,
                                  factorise_portable,     solve_portable,
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

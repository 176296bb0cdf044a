// Solver, sparse: numeric LDL^T factorisation on panels.
// Source: right-looking LDL^T as in Golub and Van Loan, Matrix Computations, 4.1 and 4.2.
#include "engine/solver/sparse/block_factor.hpp"

#include <cmath>

namespace handhold {
namespace {

using Panel = EliminationPlan::Panel;

// Kernels for loop lengths known at compile time, which halves the cost for blocks that are three
// or six wide (nearly all). 0: the length is known only at run time. The order of operations, and
// so every bit of the result, is the same.
template <std::size_t KnownDepth, std::size_t KnownWidth>
struct Kernels {
    // Factorises a panel's diagonal block in place, u -> D L^T, and updates the other columns of
    // the panel's rows.
    static void eliminate(const Panel& panel, std::span<const double> smallest_pivots, double* u,
                          double* inverse_pivots) {
        const std::size_t depth = KnownDepth != 0 ? KnownDepth : panel.width;
        const std::size_t stride = panel.stride;
        for (std::size_t m = 0; m < depth; ++m) {
            const double pivot = u[m * stride + m];
            const bool is_independent = std::abs(pivot) > smallest_pivots[panel.scalar + m];
            const double inverse = is_independent ? 1.0 / pivot : 0.0;
            inverse_pivots[panel.scalar + m] = inverse;
            for (std::size_t row = m + 1; row < depth; ++row) {
                const double factor = u[m * stride + row] * inverse;
                for (std::size_t column = row; column < stride; ++column) {
                    u[row * stride + column] -= factor * u[m * stride + column];
                }
            }
        }
    }

    // c -= sum over m of u[m][from..] / d[m] * u[m][to..]: the update of one later block by one
    // panel.
    static void subtract_product(const Panel& panel, const Panel& row_panel,
                                 const Panel& column_panel, const double* from, const double* to,
                                 const double* inverse_pivots, double* c) {
        const std::size_t depth = KnownDepth != 0 ? KnownDepth : panel.width;
        const std::size_t rows = KnownWidth != 0 ? KnownWidth : row_panel.width;
        const std::size_t columns = KnownWidth != 0 ? KnownWidth : column_panel.width;
        for (std::size_t row = 0; row < rows; ++row) {
            double* const out = c + row * row_panel.stride;
            for (std::size_t m = 0; m < depth; ++m) {
                const double factor = from[m * panel.stride + row] * inverse_pivots[m];
                for (std::size_t column = 0; column < columns; ++column) {
                    out[column] -= factor * to[m * panel.stride + column];
                }
            }
        }
    }
};

// to -= sum over m of shares[m] * rows[m].
template <std::size_t KnownWidth>
void subtract_rows(const double* rows, std::size_t stride, const double* shares, std::size_t depth,
                   std::size_t width, double* to) {
    const std::size_t height = KnownWidth != 0 ? KnownWidth : depth;
    const std::size_t count = KnownWidth != 0 ? KnownWidth : width;
    for (std::size_t m = 0; m < height; ++m) {
        for (std::size_t i = 0; i < count; ++i) {
            to[i] -= rows[m * stride + i] * shares[m];
        }
    }
}

// own[m] -= rows[m] . from.
template <std::size_t KnownWidth>
void subtract_products(const double* rows, std::size_t stride, const double* from,
                       std::size_t depth, std::size_t width, double* own) {
    const std::size_t height = KnownWidth != 0 ? KnownWidth : depth;
    const std::size_t count = KnownWidth != 0 ? KnownWidth : width;
    for (std::size_t m = 0; m < height; ++m) {
        double sum = own[m];
        for (std::size_t i = 0; i < count; ++i) {
            sum -= rows[m * stride + i] * from[i];
        }
        own[m] = sum;
    }
}

// Forward substitution: subtracts the contribution of a panel's unknowns from all later ones.
template <std::size_t KnownWidth>
void carry_forward(const EliminationPlan& plan, const Panel& panel, const double* u,
                   const double* inverse_pivots, double* unknowns) {
    const std::size_t width = KnownWidth != 0 ? KnownWidth : panel.width;
    double* const own = unknowns + panel.scalar;
    double shares[KnownWidth != 0 ? KnownWidth : k_widest_node];
    for (std::size_t m = 0; m < width; ++m) {
        shares[m] = own[m] * inverse_pivots[panel.scalar + m];
        for (std::size_t i = m + 1; i < width; ++i) {
            own[i] -= u[m * panel.stride + i] * shares[m];
        }
    }
    for (const EliminationPlan::Block& block : plan.blocks(panel)) {
        const Panel& later = plan.panels()[block.panel];
        const double* const rows = u + block.column;
        double* const to = unknowns + later.scalar;
        if (KnownWidth != 0 && later.width == KnownWidth) {
            subtract_rows<KnownWidth>(rows, panel.stride, shares, width, KnownWidth, to);
        } else {
            subtract_rows<0>(rows, panel.stride, shares, width, later.width, to);
        }
    }
}

// Backward substitution: solves a panel's unknowns from the later ones, which are known.
template <std::size_t KnownWidth>
void solve_backward(const EliminationPlan& plan, const Panel& panel, const double* u,
                    const double* inverse_pivots, double* unknowns) {
    const std::size_t width = KnownWidth != 0 ? KnownWidth : panel.width;
    double* const own = unknowns + panel.scalar;
    for (const EliminationPlan::Block& block : plan.blocks(panel)) {
        const Panel& later = plan.panels()[block.panel];
        const double* const rows = u + block.column;
        const double* const from = unknowns + later.scalar;
        if (KnownWidth != 0 && later.width == KnownWidth) {
            subtract_products<KnownWidth>(rows, panel.stride, from, width, KnownWidth, own);
        } else {
            subtract_products<0>(rows, panel.stride, from, width, later.width, own);
        }
    }
    for (std::size_t m = width; m-- > 0;) {
        for (std::size_t i = m + 1; i < width; ++i) {
            own[m] -= u[m * panel.stride + i] * own[i];
        }
        own[m] *= inverse_pivots[panel.scalar + m];
    }
}

}  // namespace

void BlockFactor::resize(const EliminationPlan& plan) {
    values_.resize(plan.value_count());
    inverse_pivots_.resize(plan.scalar_count());
}

void BlockFactor::eliminate_panel(const Panel& panel, std::span<const double> smallest_pivots) {
    double* const u = &values_[panel.begin];
    if (panel.width == 3) {
        Kernels<3, 0>::eliminate(panel, smallest_pivots, u, inverse_pivots_.data());
    } else if (panel.width == 6) {
        Kernels<6, 0>::eliminate(panel, smallest_pivots, u, inverse_pivots_.data());
    } else {
        Kernels<0, 0>::eliminate(panel, smallest_pivots, u, inverse_pivots_.data());
    }
}

void BlockFactor::update_later_panels(const EliminationPlan& plan, const Panel& panel) {
    const std::span<const EliminationPlan::Block> blocks = plan.blocks(panel);
    const std::uint32_t* target = plan.updates().data() + panel.updates;
    const double* const u = &values_[panel.begin];
    const double* const inverse_pivots = &inverse_pivots_[panel.scalar];
    for (std::size_t x = 0; x < blocks.size(); ++x) {
        const Panel& rows = plan.panels()[blocks[x].panel];
        for (std::size_t y = x; y < blocks.size(); ++y) {
            const Panel& columns = plan.panels()[blocks[y].panel];
            const double* const from = u + blocks[x].column;
            const double* const to = u + blocks[y].column;
            double* const c = &values_[*target];
            const bool are_equal = panel.width == rows.width && panel.width == columns.width;
            if (are_equal && panel.width == 3) {
                Kernels<3, 3>::subtract_product(panel, rows, columns, from, to, inverse_pivots, c);
            } else if (are_equal && panel.width == 6) {
                Kernels<6, 6>::subtract_product(panel, rows, columns, from, to, inverse_pivots, c);
            } else {
                Kernels<0, 0>::subtract_product(panel, rows, columns, from, to, inverse_pivots, c);
            }
            ++target;
        }
    }
}

void BlockFactor::factorise(const EliminationPlan& plan, std::span<const double> smallest_pivots) {
    for (const EliminationPlan::Panel& panel : plan.panels()) {
        eliminate_panel(panel, smallest_pivots);
        update_later_panels(plan, panel);
    }
}

void BlockFactor::substitute(const EliminationPlan& plan, std::span<double> unknowns) const {
    for (const Panel& panel : plan.panels()) {
        const auto carry = panel.width == 3 ? carry_forward<3> : carry_forward<0>;
        carry(plan, panel, &values_[panel.begin], inverse_pivots_.data(), unknowns.data());
    }
    for (std::size_t place = plan.panels().size(); place-- > 0;) {
        const Panel& panel = plan.panels()[place];
        const auto solve = panel.width == 3 ? solve_backward<3> : solve_backward<0>;
        solve(plan, panel, &values_[panel.begin], inverse_pivots_.data(), unknowns.data());
    }
}

}  // namespace handhold

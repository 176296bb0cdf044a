// Sources: right-looking LDL^T on panels, as in Golub and Van Loan, Matrix Computations, 4.1 and
// 4.2.
#include "engine/solver/block_factor.hpp"

#include <cmath>

namespace handhold {
namespace {

using Panel = EliminationPlan::Panel;

// Blocks are three or six wide nearly always: loops of a length known to the compiler cost half.
// 0: known at run time only. The order of operations is the same.
template <std::uint32_t known_depth, std::uint32_t known_width>
struct Kernels {
    // u -> D L^T within a panel's own rows.
    static void eliminate(const Panel& panel, std::span<const double> smallest_pivots, double* u,
                          double* inverse_pivots) {
        const std::uint32_t depth = known_depth != 0 ? known_depth : panel.width;
        const std::uint32_t stride = panel.stride;
        for (std::uint32_t m = 0; m < depth; ++m) {
            const double pivot = u[m * stride + m];
            const bool counts = std::abs(pivot) > smallest_pivots[panel.scalar + m];
            const double inverse = counts ? 1.0 / pivot : 0.0;
            inverse_pivots[panel.scalar + m] = inverse;
            for (std::uint32_t row = m + 1; row < depth; ++row) {
                const double factor = u[m * stride + row] * inverse;
                for (std::uint32_t column = row; column < stride; ++column) {
                    u[row * stride + column] -= factor * u[m * stride + column];
                }
            }
        }
    }

    // c -= sum over m of u[m][from..] / d[m] u[m][to..]: two blocks' columns in one panel.
    static void subtract_product(const Panel& panel, const Panel& row_panel,
                                 const Panel& column_panel, const double* from, const double* to,
                                 const double* inverse_pivots, double* c) {
        const std::uint32_t depth = known_depth != 0 ? known_depth : panel.width;
        const std::uint32_t rows = known_width != 0 ? known_width : row_panel.width;
        const std::uint32_t columns = known_width != 0 ? known_width : column_panel.width;
        for (std::uint32_t row = 0; row < rows; ++row) {
            double* const out = c + row * row_panel.stride;
            for (std::uint32_t m = 0; m < depth; ++m) {
                const double factor = from[m * panel.stride + row] * inverse_pivots[m];
                for (std::uint32_t column = 0; column < columns; ++column) {
                    out[column] -= factor * to[m * panel.stride + column];
                }
            }
        }
    }
};

template <std::uint32_t known_width>
void scatter(const double* row, double share, std::uint32_t width, double* unknowns) {
    const std::uint32_t count = known_width != 0 ? known_width : width;
    for (std::uint32_t i = 0; i < count; ++i) {
        unknowns[i] -= row[i] * share;
    }
}

template <std::uint32_t known_width>
double gather(const double* row, double sum, std::uint32_t width, const double* unknowns) {
    const std::uint32_t count = known_width != 0 ? known_width : width;
    for (std::uint32_t i = 0; i < count; ++i) {
        sum -= row[i] * unknowns[i];
    }
    return sum;
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
        for (std::uint32_t m = 0; m < panel.width; ++m) {
            const double* const row = &values_[panel.begin + m * panel.stride];
            const double share = unknowns[panel.scalar + m] * inverse_pivots_[panel.scalar + m];
            for (std::uint32_t i = m + 1; i < panel.width; ++i) {
                unknowns[panel.scalar + i] -= row[i] * share;
            }
            for (const EliminationPlan::Block& block : plan.blocks(panel)) {
                const Panel& later = plan.panels()[block.panel];
                double* const to = &unknowns[later.scalar];
                if (later.width == 3) {
                    scatter<3>(row + block.column, share, 3, to);
                } else {
                    scatter<0>(row + block.column, share, later.width, to);
                }
            }
        }
    }
    for (std::size_t place = plan.panels().size(); place-- > 0;) {
        const Panel& panel = plan.panels()[place];
        for (std::uint32_t m = panel.width; m-- > 0;) {
            const double* const row = &values_[panel.begin + m * panel.stride];
            double sum = unknowns[panel.scalar + m];
            for (std::uint32_t i = m + 1; i < panel.width; ++i) {
                sum -= row[i] * unknowns[panel.scalar + i];
            }
            for (const EliminationPlan::Block& block : plan.blocks(panel)) {
                const Panel& later = plan.panels()[block.panel];
                const double* const of = &unknowns[later.scalar];
                sum = later.width == 3 ? gather<3>(row + block.column, sum, 3, of)
                                       : gather<0>(row + block.column, sum, later.width, of);
            }
            unknowns[panel.scalar + m] = sum * inverse_pivots_[panel.scalar + m];
        }
    }
}

}  // namespace handhold

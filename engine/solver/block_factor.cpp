// Sources: right-looking LDL^T on panels, as in Golub and Van Loan, Matrix Computations, 4.1 and
// 4.2.
#include "engine/solver/block_factor.hpp"

#include <cmath>

namespace handhold {
namespace {

// c -= sum over m of u[m][..] / d[m] u[m][..]: `from` and `to` are two blocks' columns in the rows
// of one panel. Widths known at compile time where they are common: loops of three cost more to
// begin than to run.
template <std::uint32_t depth, std::uint32_t rows, std::uint32_t columns>
void subtract_product_of(const double* u, std::uint32_t stride, std::uint32_t from,
                         std::uint32_t to, const double* inverse_pivots, double* c,
                         std::uint32_t c_stride) {
    for (std::uint32_t row = 0; row < rows; ++row) {
        double sums[columns];
        for (std::uint32_t column = 0; column < columns; ++column) {
            sums[column] = c[row * c_stride + column];
        }
        for (std::uint32_t m = 0; m < depth; ++m) {
            const double factor = u[m * stride + from + row] * inverse_pivots[m];
            for (std::uint32_t column = 0; column < columns; ++column) {
                sums[column] -= factor * u[m * stride + to + column];
            }
        }
        for (std::uint32_t column = 0; column < columns; ++column) {
            c[row * c_stride + column] = sums[column];
        }
    }
}

void subtract_product(std::uint32_t depth, std::uint32_t rows, std::uint32_t columns,
                      const double* u, std::uint32_t stride, std::uint32_t from, std::uint32_t to,
                      const double* inverse_pivots, double* c, std::uint32_t c_stride) {
    if (depth == 3 && rows == 3 && columns == 3) {
        subtract_product_of<3, 3, 3>(u, stride, from, to, inverse_pivots, c, c_stride);
        return;
    }
    if (depth == 6 && rows == 6 && columns == 6) {
        subtract_product_of<6, 6, 6>(u, stride, from, to, inverse_pivots, c, c_stride);
        return;
    }
    for (std::uint32_t row = 0; row < rows; ++row) {
        for (std::uint32_t m = 0; m < depth; ++m) {
            const double factor = u[m * stride + from + row] * inverse_pivots[m];
            for (std::uint32_t column = 0; column < columns; ++column) {
                c[row * c_stride + column] -= factor * u[m * stride + to + column];
            }
        }
    }
}

}  // namespace

void BlockFactor::resize(const EliminationPlan& plan) {
    values_.resize(plan.value_count());
    inverse_pivots_.resize(plan.scalar_count());
}

void BlockFactor::eliminate_panel(const EliminationPlan::Panel& panel,
                                  std::span<const double> smallest_pivots) {
    double* const u = &values_[panel.begin];
    for (std::uint32_t m = 0; m < panel.width; ++m) {
        const double pivot = u[m * panel.stride + m];
        const bool counts = std::abs(pivot) > smallest_pivots[panel.scalar + m];
        const double inverse = counts ? 1.0 / pivot : 0.0;
        inverse_pivots_[panel.scalar + m] = inverse;
        for (std::uint32_t row = m + 1; row < panel.width; ++row) {
            const double factor = u[m * panel.stride + row] * inverse;
            for (std::uint32_t column = row; column < panel.stride; ++column) {
                u[row * panel.stride + column] -= factor * u[m * panel.stride + column];
            }
        }
    }
}

void BlockFactor::update_later_panels(const EliminationPlan& plan,
                                      const EliminationPlan::Panel& panel) {
    const std::span<const EliminationPlan::Block> blocks = plan.blocks(panel);
    const std::uint32_t* target = plan.updates().data() + panel.updates;
    for (std::size_t x = 0; x < blocks.size(); ++x) {
        const EliminationPlan::Panel& later = plan.panels()[blocks[x].panel];
        for (std::size_t y = x; y < blocks.size(); ++y) {
            subtract_product(panel.width, later.width, plan.panels()[blocks[y].panel].width,
                             &values_[panel.begin], panel.stride, blocks[x].column,
                             blocks[y].column, &inverse_pivots_[panel.scalar], &values_[*target],
                             later.stride);
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
    const auto visit_blocks = [&](const EliminationPlan::Panel& panel, const double* row,
                                  auto&& visit) {
        for (const EliminationPlan::Block& block : plan.blocks(panel)) {
            const EliminationPlan::Panel& later = plan.panels()[block.panel];
            for (std::uint32_t i = 0; i < later.width; ++i) {
                visit(row[block.column + i], unknowns[later.scalar + i]);
            }
        }
    };
    for (const EliminationPlan::Panel& panel : plan.panels()) {
        for (std::uint32_t m = 0; m < panel.width; ++m) {
            const double* const row = &values_[panel.begin + m * panel.stride];
            const double share = unknowns[panel.scalar + m] * inverse_pivots_[panel.scalar + m];
            for (std::uint32_t i = m + 1; i < panel.width; ++i) {
                unknowns[panel.scalar + i] -= row[i] * share;
            }
            visit_blocks(panel, row,
                         [share](double entry, double& unknown) { unknown -= entry * share; });
        }
    }
    for (std::size_t place = plan.panels().size(); place-- > 0;) {
        const EliminationPlan::Panel& panel = plan.panels()[place];
        for (std::uint32_t m = panel.width; m-- > 0;) {
            const double* const row = &values_[panel.begin + m * panel.stride];
            double sum = unknowns[panel.scalar + m];
            for (std::uint32_t i = m + 1; i < panel.width; ++i) {
                sum -= row[i] * unknowns[panel.scalar + i];
            }
            visit_blocks(panel, row,
                         [&sum](double entry, double unknown) { sum -= entry * unknown; });
            unknowns[panel.scalar + m] = sum * inverse_pivots_[panel.scalar + m];
        }
    }
}

}  // namespace handhold

#include "engine/math/penalty_quadratic.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/core/check.hpp"

namespace handhold {
namespace {

constexpr int k_max_newton_steps = 24;
constexpr int k_max_line_steps = 16;
constexpr double k_converged = 1e-10;  // relative length of the last step

// Replaces the lower triangle of `matrix` by its Cholesky factor L and `vector` by the solution of
// L L^T x = vector.
void solve_positive_definite(UnknownsSquare& matrix, Unknowns& vector, std::size_t count) {
    const auto n = static_cast<Eigen::Index>(count);
    constexpr double k_min_pivot = 1e-30;
    for (Eigen::Index j = 0; j < n; ++j) {
        const double pivot = matrix(j, j) - matrix.row(j).head(j).squaredNorm();
        matrix(j, j) = std::sqrt(std::max(pivot, k_min_pivot));
        for (Eigen::Index i = j + 1; i < n; ++i) {
            matrix(i, j) =
                (matrix(i, j) - matrix.row(i).head(j).dot(matrix.row(j).head(j))) / matrix(j, j);
        }
    }
    for (Eigen::Index i = 0; i < n; ++i) {
        vector[i] = (vector[i] - matrix.row(i).head(i).dot(vector.head(i))) / matrix(i, i);
    }
    for (Eigen::Index i = n; i-- > 0;) {
        const Eigen::Index below = n - i - 1;
        vector[i] =
            (vector[i] - matrix.col(i).segment(i + 1, below).dot(vector.segment(i + 1, below))) /
            matrix(i, i);
    }
}

// Index of the only slope that is not 0; -1: there are several, or none. About half of the rows
// limit one unknown.
int only_slope(const Unknowns& slope) {
    int only = -1;
    for (int i = 0; i < static_cast<int>(k_max_unknowns); ++i) {
        if (slope[i] != 0.0) {
            if (only >= 0) {
                return -1;
            }
            only = i;
        }
    }
    return only;
}

// Value of an inequality along a step: value + length * along.
struct RowOnLine {
    double value;
    double along;
    double weight;
};

// Returns the step length in [0, 1] that minimises the function along the step. Its slope is
//   slope_at_zero + length * curvature + the contributions of the violated rows.
// The slope rises with the length, and is linear between the lengths at which a row changes between
// violated and satisfied. Newton's method, kept between bounds, finds its zero.
double best_length(double slope_at_zero, double curvature, std::span<const RowOnLine> rows) {
    constexpr double k_same = 1e-9;
    double low = 0.0;
    double high = 1.0;
    double length = 1.0;
    for (int i = 0; i < k_max_line_steps; ++i) {
        double slope = slope_at_zero + length * curvature;
        double change = curvature;
        for (const RowOnLine& row : rows) {
            const double value = row.value + length * row.along;
            if (value < 0.0) {
                slope += row.weight * value * row.along;
                change += row.weight * row.along * row.along;
            }
        }
        if (length == 1.0 && slope <= 0.0) {
            return 1.0;
        }
        (slope > 0.0 ? high : low) = length;
        if (!(change > 0.0)) {
            break;
        }
        const double next = length - slope / change;
        const double kept = next > low && next < high ? next : 0.5 * (low + high);
        if (std::abs(kept - length) < k_same) {
            return kept;
        }
        length = kept;
    }
    return length;
}

}  // namespace

Unknowns minimise_penalised(const UnknownsSquare& hessian, const Unknowns& gradient,
                            std::span<const PenaltyRow> rows, std::size_t count) {
    HH_CHECK(count <= k_max_unknowns && rows.size() <= k_max_penalty_rows, "a small problem",
             count);
    const auto n = static_cast<Eigen::Index>(count);
    std::array<double, k_max_penalty_rows> values;   // NOLINT(*-member-init): filled as far as used
    std::array<double, k_max_penalty_rows> along;    // NOLINT(*-member-init)
    std::array<RowOnLine, k_max_penalty_rows> line;  // NOLINT(*-member-init)
    std::array<int, k_max_penalty_rows> only;        // NOLINT(*-member-init)
    for (std::size_t r = 0; r < rows.size(); ++r) {
        values[r] = rows[r].value;
        only[r] = only_slope(rows[r].slope);
    }
    Unknowns x = Unknowns::Zero();
    for (int newton = 0; newton < k_max_newton_steps; ++newton) {
        UnknownsSquare matrix = hessian;
        const Unknowns turned = hessian.lazyProduct(x);
        Unknowns step = -gradient - turned;
        for (std::size_t r = 0; r < rows.size(); ++r) {
            const auto& [slope, value, weight] = rows[r];
            const int i = only[r];
            if (values[r] >= 0.0) {
                continue;
            }
            if (i >= 0) {
                step[i] -= weight * values[r] * slope[i];
                matrix(i, i) += weight * slope[i] * slope[i];
                continue;
            }
            step -= weight * values[r] * slope;
            for (Eigen::Index k = 0; k < n; ++k) {
                if (slope[k] != 0.0) {
                    matrix.row(k).head(k + 1) += weight * slope[k] * slope.head(k + 1).transpose();
                }
            }
        }
        step.tail(static_cast<Eigen::Index>(k_max_unknowns) - n).setZero();
        solve_positive_definite(matrix, step, count);
        std::size_t line_count = 0;  // rows that are violated somewhere along the step
        for (std::size_t r = 0; r < rows.size(); ++r) {
            const int i = only[r];
            along[r] = i >= 0 ? rows[r].slope[i] * step[i] : rows[r].slope.dot(step);
            if (std::min(values[r], values[r] + along[r]) < 0.0) {
                line[line_count++] = {values[r], along[r], rows[r].weight};
            }
        }
        const Unknowns bent = hessian.lazyProduct(step);
        const double length = best_length(turned.dot(step) + gradient.dot(step), bent.dot(step),
                                          {line.data(), line_count});
        x += length * step;
        // If the whole step is taken and the same rows stay violated, it ends exactly at the
        // minimum.
        bool is_exact = length == 1.0;
        for (std::size_t r = 0; r < rows.size(); ++r) {
            const double before = values[r];
            values[r] += length * along[r];
            is_exact = is_exact && (before < 0.0) == (values[r] < 0.0);
        }
        if (is_exact || length * step.norm() <= k_converged * (1.0 + x.norm())) {
            break;
        }
    }
    return x;
}

}  // namespace handhold

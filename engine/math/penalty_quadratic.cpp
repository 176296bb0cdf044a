#include "engine/math/penalty_quadratic.hpp"

#include <algorithm>
#include <cmath>

namespace handhold {
namespace {

constexpr int k_max_steps = 24;
constexpr int k_max_line_steps = 16;
constexpr double k_converged = 1e-12;  // relative length of the last step

// Replaces the lower triangle of `matrix` by its Cholesky factor L and `vector` by the solution of
// L L^T x = vector.
void solve_positive_definite(UnknownsSquare& matrix, Unknowns& vector, std::size_t count) {
    const auto n = static_cast<Eigen::Index>(count);
    constexpr double k_min_pivot = 1e-30;
    for (Eigen::Index j = 0; j < n; ++j) {
        const double pivot =
            matrix(j, j) - matrix.row(j).head(j).squaredNorm();
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

// Step length in [0, 1] that minimises the function from x along `step`: the zero of its slope,
// which rises with the length and is linear between the rows' changes. Found by Newton's method
// between bounds.
double best_length(const UnknownsSquare& hessian, const Unknowns& gradient,
                   std::span<const PenaltyRow> rows, const Unknowns& x, const Unknowns& step,
                   std::size_t count) {
    const auto n = static_cast<Eigen::Index>(count);
    Unknowns turned = Unknowns::Zero();
    for (Eigen::Index i = 0; i < n; ++i) {
        turned[i] = hessian.row(i).head(n).dot(step.head(n));
    }
    const double slope_at_zero = turned.head(n).dot(x.head(n)) + gradient.head(n).dot(step.head(n));
    const double curvature = turned.head(n).dot(step.head(n));
    double low = 0.0;
    double high = 1.0;
    double length = 1.0;
    for (int i = 0; i < k_max_line_steps; ++i) {
        double slope = slope_at_zero + length * curvature;
        double change = curvature;
        for (const PenaltyRow& row : rows) {
            const double along = row.slope.head(n).dot(step.head(n));
            const double gap = row.value + row.slope.head(n).dot(x.head(n)) + length * along;
            if (gap < 0.0) {
                slope += row.weight * gap * along;
                change += row.weight * along * along;
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
        if (std::abs(kept - length) < 1e-9) {
            return kept;
        }
        length = kept;
    }
    return length;
}

}  // namespace

Unknowns minimise_penalised(const UnknownsSquare& hessian, const Unknowns& gradient,
                            std::span<const PenaltyRow> rows, std::size_t count) {
    const auto n = static_cast<Eigen::Index>(count);
    Unknowns x = Unknowns::Zero();
    for (int i = 0; i < k_max_steps; ++i) {
        UnknownsSquare matrix = hessian;
        Unknowns step = Unknowns::Zero();
        for (Eigen::Index k = 0; k < n; ++k) {
            step[k] = -gradient[k] - hessian.row(k).head(n).dot(x.head(n));
        }
        for (const PenaltyRow& row : rows) {
            const double gap = row.value + row.slope.head(n).dot(x.head(n));
            if (gap >= 0.0) {
                continue;
            }
            step.head(n) -= row.weight * gap * row.slope.head(n);
            for (Eigen::Index k = 0; k < n; ++k) {
                matrix.row(k).head(k + 1) +=
                    row.weight * row.slope[k] * row.slope.head(k + 1).transpose();
            }
        }
        solve_positive_definite(matrix, step, count);
        const double length = best_length(hessian, gradient, rows, x, step, count);
        x.head(n) += length * step.head(n);
        if (length * step.head(n).norm() <= k_converged * (1.0 + x.head(n).norm())) {
            break;
        }
    }
    return x;
}

}  // namespace handhold

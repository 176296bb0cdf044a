#pragma once

#include <cstddef>
#include <span>

#include "engine/math/math.hpp"
#include "engine/math/processor.hpp"

// A small dense quadratic programme whose inequalities are penalties: inequalities that cannot all
// be satisfied are violated in the least-squares sense, so that a solution always exists.
namespace handhold {

inline constexpr std::size_t k_max_unknowns = 28;  // a multiple of 4
inline constexpr std::size_t k_max_penalty_rows = 320;

using Unknowns = Eigen::Matrix<double, static_cast<int>(k_max_unknowns), 1>;
using UnknownsSquare = Eigen::Matrix<double, static_cast<int>(k_max_unknowns),
                                     static_cast<int>(k_max_unknowns), Eigen::RowMajor>;

// The row slope . x + value >= 0. A row that is violated by v costs 0.5 * weight * v^2.
struct PenaltyRow {
    Unknowns slope = Unknowns::Zero();
    double value = 0.0;
    double weight = 1.0;  // > 0
    // Index of the only slope that is not 0, which makes the row cheaper; -1: several, or unknown.
    int only = -1;
};

// Minimises 0.5 x^T H x + g^T x + the rows' penalties over the first `count` unknowns; the others
// stay 0. Newton's method on the violated rows with an exact line search, which ends after finitely
// many steps because the function is convex and piecewise quadratic (Madsen, Nielsen, A finite
// smoothing algorithm for linear l1 estimation, 1993, use the same argument). Deterministic, does
// not allocate. Preconditions: H is symmetric and positive definite, everything is finite, slopes
// and gradient are 0 beyond the first `count` unknowns, count <= k_max_unknowns,
// rows.size() <= k_max_penalty_rows. Both `vectors` give equal bits.
Unknowns minimise_penalised(const UnknownsSquare& hessian, const Unknowns& gradient,
                            std::span<const PenaltyRow> rows, std::size_t count,
                            Vectors vectors = fastest_vectors());

}  // namespace handhold

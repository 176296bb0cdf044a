// Solver, newton: the normal equations of one island's rows,
//   (J W J^T + diag(alpha)) lambda = -residual
// with unilateral rows (lambda >= 0, residual after the step >= 0, one of the two 0) handled by an
// active set.

#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "engine/solver/model/rows.hpp"
#include "engine/solver/newton/settings.hpp"
#include "engine/solver/sparse/row_matrix.hpp"

namespace handhold {

class RowSystem {
  public:
    using Twist = RowMatrix::Twist;

    // Assembles J W J^T. A unilateral row that also existed in the previous rows keeps its state
    // (active or inactive) as a warm start. `inverse_inertia_ws` is by slot and has one entry per
    // body of the island.
    void assemble(std::span<const SolverBody> bodies, std::span<const Mat3> inverse_inertia_ws,
                  std::span<const Row> rows);
    // Work that later solves may spend until the next call, in the unit of WorkBudget. A solve
    // takes at least one factorisation; beyond the limit it ends with an unconverged active set.
    void limit_work(std::uint64_t limit) {
        work_ = 0;
        max_work_ = limit;
    }
    std::uint64_t work() const { return work_; }
    bool is_out_of_work() const { return work_ >= max_work_; }
    // Discards the warm start: the next rows are unrelated to the previous ones.
    void reset_active_set() { keys_.clear(); }

    std::size_t size() const { return matrix_.size(); }
    double diagonal(std::size_t row) const { return matrix_.diagonal(row); }
    // The regularisation diag(alpha): one value per row, >= 0. Takes effect with the next `solve`.
    // Do not write to the span after that: call alpha() again.
    std::span<double> alpha() { return matrix_.alpha(); }

    // Solves for the multipliers of all rows. Unilateral rows push (lambda >= 0) or are inactive.
    // If the active set does not converge, no row pulls, but inactive rows may overlap, and
    //   1/2 lambda^T (J W J^T + diag(alpha)) lambda + residual^T lambda <= 0
    // over the rows whose multipliers are not fixed (residual: with the effect of the fixed ones),
    // so that the moves are at most about twice as long as those that satisfy the violated rows.
    // Rows that nothing can move (zero diagonal) get lambda 0. The result is valid until the next
    // solve or assemble.
    std::span<const double> solve(std::span<const Row> rows);
    // True if the last solve found no consistent active set: inactive rows may overlap.
    bool is_active_set_unconverged() const { return active_set_unconverged_; }
    // Solves with the last factor and active set for other residuals (iterative refinement).
    std::span<const double> solve_with_last_factor(std::span<const double> values);
    bool is_active(std::size_t row) const { return active_[row] != 0 && fixed_[row] == 0; }
    // Fixes a row's multiplier from the next solve until the next assemble or free_multiplier. Used
    // for sliding friction.
    void fix_multiplier(std::size_t row, double lambda);
    void free_multiplier(std::size_t row);
    // Moves of the bodies in the last solve, W J^T lambda; by slot.
    std::span<const Twist> moves() const { return matrix_.moves(); }
    // A row's residual after the last solve: value + J W J^T lambda.
    double remaining_residual(std::size_t row, double value) const;

  private:
    void warm_start_active_set(std::span<const Row> rows);
    void solve_active();
    bool block_pivot(std::span<const Row> rows);
    void shorten_unbalanced();
    bool descend_active_set(std::span<const Row> rows);
    struct Approach {
        bool reaches_solution = false;
        bool moves = false;  // any multiplier changed
    };
    Approach step_towards_solution(std::span<const Row> rows);
    double worst_remaining_residual(std::span<const Row> rows) const;
    bool activate_overlapping(std::span<const Row> rows, bool only_worst);
    bool violates_complementarity(const Row& row, std::size_t index) const;

    RowMatrix matrix_;
    std::vector<double> lambda_;
    std::vector<double> values_;
    std::vector<std::uint8_t> active_;
    // Identity (block, index within the block) and state of the rows and of the previous rows.
    std::vector<std::uint64_t> keys_;
    std::vector<std::uint64_t> previous_keys_;
    std::vector<std::uint8_t> previous_active_;
    std::vector<std::uint8_t> fixed_;
    std::vector<double> fixed_lambda_;
    std::vector<std::uint8_t> chosen_;  // active and not fixed
    std::vector<std::uint32_t> violating_rows_;
    // current point of the descent, at which no multiplier pulls
    std::vector<double> feasible_lambda_;
    bool active_set_unconverged_ = false;
    std::uint64_t work_ = 0;
    std::uint64_t max_work_ = std::numeric_limits<std::uint64_t>::max();
};

}  // namespace handhold

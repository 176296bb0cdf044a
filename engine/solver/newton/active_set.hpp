#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/solver/model/rows.hpp"
#include "engine/solver/sparse/row_matrix.hpp"

// The normal equations of one island's rows, (J W J^T + diag(alpha)) lambda = -value, with
// unilateral rows by an active set.
namespace handhold {

class RowSystem {
  public:
    using Twist = RowMatrix::Twist;

    // Fills J W J^T. Unilateral rows that the rows before had too begin as they ended there.
    // `inverse_inertia_ws` by the bodies' slots, as many as the island has bodies.
    void assemble(std::span<const SolverBody> bodies, std::span<const Mat3> inverse_inertia_ws,
                  std::span<const Row> rows);
    // The next rows are no later state of those before: nothing is known of who acts.
    void reset_active_set() { keys_.clear(); }

    std::size_t size() const { return matrix_.size(); }
    double diagonal(std::size_t row) const { return matrix_.diagonal(row); }
    // Added to the diagonal from now on; one number a row, >= 0.
    std::span<double> alpha() { return matrix_.alpha(); }

    // Solves for all rows; unilateral ones push (lambda >= 0) or are left out. Where the changes of
    // the active set run out, nothing pulls, but rows left out may overlap. The result is valid
    // until the next solve or assemble. Rows that nothing can move (zero diagonal) get lambda 0.
    std::span<const double> solve(std::span<const Row> rows);
    // True where the last solve found no active set: rows left out may overlap.
    bool is_active_set_unconverged() const { return active_set_unconverged_; }
    // The same factor and active set against other values: for refinement.
    std::span<const double> solve_with_last_factor(std::span<const double> values);
    bool is_active(std::size_t row) const { return active_[row] != 0 && fixed_[row] == 0; }
    // The row's multiplier is given, not solved for, from the next solve until the next assemble or
    // release: a friction that slides.
    void fix_multiplier(std::size_t row, double lambda);
    void free_multiplier(std::size_t row);
    // How the last solve moves the bodies: W J^T lambda, by slot.
    std::span<const Twist> moves() const { return matrix_.moves(); }
    // What is left of a row's value after the last solve: value + J W J^T lambda.
    double remaining_residual(std::size_t row, double value) const;

  private:
    void warm_start_active_set(std::span<const Row> rows);
    void solve_active();
    bool block_pivot(std::span<const Row> rows);
    bool descend_active_set(std::span<const Row> rows);
    struct Approach {
        bool reaches_solution = false;
        bool moves = false;  // anything at all
    };
    Approach step_towards_solution(std::span<const Row> rows);
    double worst_remaining_residual(std::span<const Row> rows) const;
    bool activate_overlapping(std::span<const Row> rows, bool only_worst);
    bool violates_complementarity(const Row& row, std::size_t index) const;

    RowMatrix matrix_;
    std::vector<double> lambda_;
    std::vector<double> values_;
    std::vector<std::uint8_t> active_;
    // Of the rows before these: which of a block's rows, and whether it acted.
    std::vector<std::uint64_t> keys_;
    std::vector<std::uint64_t> previous_keys_;
    std::vector<std::uint8_t> previous_active_;
    std::vector<std::uint8_t> fixed_;
    std::vector<double> fixed_lambda_;
    std::vector<std::uint8_t> chosen_;  // active and not held
    std::vector<std::uint32_t> violating_rows_;
    std::vector<double> feasible_lambda_;  // multipliers none of which pulls
    bool active_set_unconverged_ = false;
};

}  // namespace handhold

#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/solver/rows.hpp"

// The normal equations of one island's rows, (J W J^T + diag(alpha)) lambda = -value, factorised
// within their envelope (each row from its first entry on), with unilateral rows by an active set.
// Plain loops over doubles in a fixed order: equal bits on every compiler.
namespace handhold {

class DenseSystem {
  public:
    // Fills J W J^T. `inverse_inertia_ws` by the bodies' slots.
    void assemble(std::span<const SolverBody> bodies, std::span<const Mat3> inverse_inertia_ws,
                  std::span<const Row> rows);

    std::size_t size() const { return size_; }
    double diagonal(std::size_t row) const { return matrix_[row * size_ + row]; }
    // Added to the diagonal from now on; one number a row, >= 0.
    std::span<double> alpha() { return alpha_; }

    // Solves for all rows; unilateral ones push (lambda >= 0) or are left out. At most 40 changes
    // of the active set. The result is valid until the next assemble. Rows that nothing can move
    // (zero diagonal) get lambda 0.
    std::span<const double> solve(std::span<const Row> rows);
    // The same factor and active set against other values: for refinement.
    std::span<const double> solve_again(std::span<const double> values);
    bool is_active(std::size_t row) const { return active_[row] != 0 && held_[row] == 0; }
    // The row's multiplier is given, not solved for, from the next solve until the next assemble or
    // release: a friction that slides.
    void hold(std::size_t row, double lambda);
    void release(std::size_t row);
    // What is left of a row's value after the last solve: value + J W J^T lambda.
    double remainder(std::size_t row, double value) const;

  private:
    void factorise();
    void substitute(std::span<const double> values);
    void apply_held();
    bool is_wrong(const Row& row, std::size_t index) const;

    std::size_t size_ = 0;
    std::vector<double> matrix_;  // row-major, symmetric, both halves
    std::vector<double> alpha_;
    // Of the active rows: L without its unit diagonal, D on the diagonal; nothing left of first_.
    std::vector<double> factor_;
    std::vector<std::uint32_t> first_;
    std::vector<double> undivided_;  // the row of L D that is being made
    std::vector<double> lambda_;
    std::vector<double> values_;
    std::vector<double> work_;
    std::vector<std::uint8_t> active_;
    std::vector<std::uint8_t> held_;
    std::vector<double> held_lambda_;
    std::vector<std::uint32_t> active_rows_;
    std::vector<std::uint32_t> wrong_rows_;
};

}  // namespace handhold

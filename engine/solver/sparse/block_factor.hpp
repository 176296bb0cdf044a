// Solver, sparse: the numeric half of the sparse LDL^T. elimination_plan.hpp is the symbolic half.

#pragma once

#include <span>
#include <vector>

#include "engine/solver/sparse/elimination_plan.hpp"

namespace handhold {

// LDL^T of a symmetric quasi-definite matrix stored in the panels of an EliminationPlan. Plain
// loops over doubles in a fixed order: the same bits on every compiler.
class BlockFactor {
  public:
    // The matrix, written by the caller before `factorise`, which replaces it by D L^T.
    std::span<double> values() { return values_; }
    void resize(const EliminationPlan& plan);

    // `smallest_pivots`, by unknown, >= 0. An unknown with a smaller pivot is linearly dependent on
    // others to within rounding; its solution is 0.
    void factorise(const EliminationPlan& plan, std::span<const double> smallest_pivots);
    // `unknowns`: in, the right-hand side; out, the solution.
    void substitute(const EliminationPlan& plan, std::span<double> unknowns) const;

  private:
    void eliminate_panel(const EliminationPlan::Panel& panel,
                         std::span<const double> smallest_pivots);
    void update_later_panels(const EliminationPlan& plan, const EliminationPlan::Panel& panel);

    std::vector<double> values_;
    std::vector<double> inverse_pivots_;  // indexed by unknown
};

}  // namespace handhold

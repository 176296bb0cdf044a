#pragma once

#include <span>
#include <vector>

#include "engine/solver/sparse/elimination_plan.hpp"

namespace handhold {

// The numeric half of a sparse LDL^T: of a symmetric quasi-definite matrix in the panels of a plan.
// Plain loops over doubles in a fixed order: equal bits on every compiler.
class BlockFactor {
  public:
    // The matrix, to be written before `factorise`, which leaves D L^T in its place.
    std::span<double> values() { return values_; }
    void resize(const EliminationPlan& plan);

    // `smallest_pivots` by unknown, >= 0: an unknown whose pivot is smaller repeats others beyond
    // what rounding tells apart, and gets no share.
    void factorise(const EliminationPlan& plan, std::span<const double> smallest_pivots);
    // Right-hand side in, solution out, by unknown.
    void substitute(const EliminationPlan& plan, std::span<double> unknowns) const;

  private:
    void eliminate_panel(const EliminationPlan::Panel& panel,
                         std::span<const double> smallest_pivots);
    void update_later_panels(const EliminationPlan& plan, const EliminationPlan::Panel& panel);

    std::vector<double> values_;
    std::vector<double> inverse_pivots_;  // by unknown
};

}  // namespace handhold

// Solver, newton: the Newton step of a heap.

#pragma once

#include <algorithm>
#include <cstdint>
#include <span>

#include "engine/solver/model/islands.hpp"
#include "engine/solver/newton/newton_rows.hpp"
#include "engine/solver/newton/newton_step.hpp"

namespace handhold {

// The Newton step of a heap: solves joints and drives exactly, contacts and limits by a bounded
// number of sweeps.
class SweepSteps {
  public:
    // Convergence limit of the last sweeps, over the stiff rows only (row_sweeps.hpp): the largest
    // change of a residual in one sweep, as a share of the solver's tolerance.
    static constexpr double k_tolerance_ratio = 0.1;
    // Convergence limit of the earlier sweeps, over all rows: the largest change of a residual.
    static constexpr double k_heap_tolerance_m = 1e-6;
    // Longest move of a loose body in a step.
    static constexpr double k_max_loose_move_m = 0.05;

    static constexpr int k_max_iterations = 6;  // Newton steps of a solve
    // maximum per Newton step, over all rows and again over the stiff rows
    static constexpr int k_max_sweeps = 30;
    // The solve ends after a step that leaves more than this share of the smallest error so far.
    static constexpr double k_stall_ratio = 0.7;

    // `tolerance_m` is NewtonSettings::tolerance_m.
    SweepSteps(const IslandView& island, double tolerance_m, SolveScratch& scratch)
        : island_(island), tolerance_m_(tolerance_m), scratch_(scratch) {
        clear_stiffness(island_, scratch_);
    }

    StepErrors evaluate(bool /*was_whole*/) {
        collect_rows(island_, scratch_.rows);
        return {.worst_m = worst_m(),
                .worst_drive_m = worst_drive_error(scratch_.rows),
                .overlap_m = worst_overlap(scratch_.rows),
                .has_contact = true};
    }
    StepWork solve(const Regularisation& regularisation, double factor) {
        prepare_inertia(island_, scratch_);
        RowSweeps& sweeps = scratch_.sweeps;
        sweeps.assemble(island_.bodies, scratch_.inverse_inertia_ws, scratch_.rows, {});
        regularise(scratch_.rows, regularisation, factor, mean_diagonal(scratch_.rows, sweeps),
                   sweeps);
        sweeps.factorise();
        gather_residuals(scratch_);
        sweeps.solve(scratch_.values,
                     {island_.max_work - std::min(work_, island_.max_work), k_max_sweeps,
                      k_heap_tolerance_m, k_tolerance_ratio * tolerance_m_});
        work_ += sweeps.work();
        largest_rotation_ = gather_moves(sweeps.moves(), scratch_);
        limit_loose_moves();
        return {.spent = work_};
    }
    double longest_move() const { return handhold::longest_move(scratch_); }
    double largest_rotation() const { return largest_rotation_; }
    double apply_moves(double scale) { return handhold::apply_moves(island_, scale, scratch_); }

  private:
    // Largest error of a row, metres; overlaps of heap contacts up to k_heap_slack_m do not count.
    double worst_m() const {
        double worst = 0.0;
        for (std::size_t i = 0; i < scratch_.rows.size(); i += scratch_.rows[i].width) {
            const Row& row = scratch_.rows[i];
            const double error = worst_error(std::span(scratch_.rows).subspan(i, row.width));
            const bool is_slack = error <= k_heap_slack_m &&
                                  is_heap_contact(island_.bodies, island_.blocks[row.block]);
            worst = is_slack ? worst : std::max(worst, error);
        }
        return worst;
    }
    // Limits the moves of loose bodies. Bodies that were spawned in one place separate over several
    // frames.
    void limit_loose_moves() {
        for (const std::uint32_t i : island_.island_bodies) {
            const SolverBody& body = island_.bodies[i];
            const double length = scratch_.moves_m[body.slot].norm();
            if (body.in_heap && length > k_max_loose_move_m) {
                scratch_.moves_m[body.slot] *= k_max_loose_move_m / length;
            }
        }
    }

    const IslandView& island_;
    double tolerance_m_;
    SolveScratch& scratch_;
    double largest_rotation_ = 0.0;
    std::uint64_t work_ = 0;
};

}  // namespace handhold

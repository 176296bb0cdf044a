// Solver, newton: the Newton step of a heap.

#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>

#include "engine/solver/model/islands.hpp"
#include "engine/solver/newton/newton_rows.hpp"
#include "engine/solver/newton/settings.hpp"

namespace handhold {

// The step of a heap: joints and drives exactly, contacts by a bounded number of sweeps.
class SweepSteps {
  public:
    // Convergence limit of the last sweeps, over the stiff rows only (row_sweeps.hpp): the largest
    // change of a residual in one sweep, as a share of the solver's tolerance.
    static constexpr double k_tolerance_ratio = 0.1;
    // Convergence limit of the earlier sweeps, over all rows: the largest change of a residual.
    static constexpr double k_heap_tolerance_m = 1e-6;
    // Longest move of a loose body in a step.
    static constexpr double k_max_loose_move_m = 0.05;

    SweepSteps(const IslandView& island, const NewtonSettings& settings, SolveScratch& scratch)
        : island_(island), settings_(settings), scratch_(scratch) {
        clear_stiffness(island_, scratch_);
    }

    void evaluate(bool /*was_full_step*/) { collect_rows(island_, scratch_.rows); }
    static void renew() {}
    // Overlaps within a heap count from k_heap_slack_m.
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
    double worst_drive_m() const { return worst_drive_error(scratch_.rows); }
    double overlap_m() const { return worst_overlap(scratch_.rows); }
    static bool has_contact() { return true; }
    static bool is_active_set_unconverged() { return false; }
    std::uint64_t work() const { return work_; }
    static bool keeps_factor() { return false; }
    static void stiffen(bool /*stiff*/) {}

    void solve(const Regularisation& regularisation, double factor) {
        prepare_inertia(island_, scratch_);
        RowSweeps& sweeps = scratch_.sweeps;
        sweeps.assemble(island_.bodies, scratch_.inverse_inertia_ws, scratch_.rows, {});
        regularise(scratch_.rows, regularisation, factor, sweeps);
        sweeps.factorise();
        scratch_.values.clear();
        for (const Row& row : scratch_.rows) {
            scratch_.values.push_back(row.residual);
        }
        sweeps.solve(scratch_.values, {settings_.max_work - std::min(work_, settings_.max_work),
                                       settings_.sweeps.max_sweeps, k_heap_tolerance_m,
                                       k_tolerance_ratio * settings_.tolerance_m});
        work_ += sweeps.work();
        largest_rotation_ = gather_moves(sweeps.moves(), scratch_);
        limit_loose_moves();
    }
    static void solve_with_last_factor() {}
    double longest_move() const { return handhold::longest_move(scratch_); }
    double largest_rotation() const { return largest_rotation_; }
    double apply_moves(double scale) { return handhold::apply_moves(island_, scale, scratch_); }
    static void restrict_to_active(double /*still_m*/) {}
    static void activate_all_rows() {}
    static bool has_cheap_factor() { return false; }
    static bool gives_up() { return true; }
    static std::optional<JointError> worst_joints() { return std::nullopt; }

  private:
    // Bodies that were spawned in one place come apart over several frames.
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
    const NewtonSettings& settings_;
    SolveScratch& scratch_;
    double largest_rotation_ = 0.0;
    std::uint64_t work_ = 0;
};

}  // namespace handhold

// Solver, newton: the damped Newton iteration of the position solve. One iteration,
//   (J W J^T + R) lambda = -C,   dx = W J^T lambda,   x += scale * dx
// is the same for islands solved row by row, in packed triads and by sweeps (newton_step.hpp).
// Sources: Levenberg-Marquardt regularisation of constrained rigid bodies; geometric stiffness
// after Tournier, Nesme, Gilles and Faure, Stable Constrained Dynamics (2015).
#include "engine/solver/newton/newton.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/math/flush_denormals.hpp"
#include "engine/solver/model/negligible.hpp"
#include "engine/solver/newton/load_stepping.hpp"
#include "engine/solver/newton/newton_rows.hpp"
#include "engine/solver/newton/newton_step.hpp"
#include "engine/solver/newton/regularisation_schedule.hpp"
#include "engine/solver/newton/sweep_steps.hpp"

namespace handhold {
namespace {

// Longest plausible move of a body by joint rows, relative to the residual; almost stretched chains
// need such moves. Without the limit, a drive that pulls across an endless rail would move a slider
// without bound.
constexpr double k_max_joint_move_ratio = 10.0;
constexpr double k_unlimited_move_m = 0.1;  // a shorter move is always plausible
// A converged solve whose drive error is above this share of the tolerance takes one more step with
// the same factor: drive errors are visible as offsets of the translating bodies.
constexpr double k_drive_tolerance_ratio = 0.1;
// Bodies that a step moves by less than this share of the tolerance count as at rest.
constexpr double k_inactive_move_ratio = 1e-3;

// --- Row by row ---------------------------------------------------------------------------------

// The step of an island solved by RowSystem: any kind of row, with an active set.
class RowSteps {
  public:
    RowSteps(const IslandView& island, SolveScratch& scratch) : island_(island), scratch_(scratch) {
        scratch_.system.reset_active_set();
        scratch_.system.limit_work(island.max_work);
        clear_stiffness(island_, scratch_);
    }

    static constexpr bool k_has_cheap_factor = false;

    // If all rows are point rows and the last step was unscaled, updates only the residuals and
    // keeps the Jacobian of the current factor until `prepare`.
    StepErrors evaluate(bool was_whole) {
        reuses_jacobian_ = was_whole && has_only_point_rows_;
        if (reuses_jacobian_) {
            update_point_residuals();
        } else {
            collect();
        }
        return {.worst_m = worst_error(scratch_.rows),
                .worst_drive_m = worst_drive_error(scratch_.rows),
                .overlap_m = worst_overlap(scratch_.rows),
                .has_contact = has_contact(scratch_.rows),
                .keeps_factor = has_only_point_rows_ || has_same_rows()};
    }
    void prepare(const StepHints& hints) {
        if (reuses_jacobian_) {
            collect();
        }
        clear_stiffness(island_, scratch_);
        has_stiffness_ = hints.adds_stiffness;
        if (has_stiffness_) {
            gather_stiffness(island_, scratch_);
        }
    }
    StepWork solve(const Regularisation& regularisation, double factor) {
        has_only_point_rows_ = has_only_point_rows();
        prepare_inertia(island_, scratch_);
        scratch_.system.assemble(island_.bodies, scratch_.inverse_inertia_ws, scratch_.rows);
        drive_scale_.update(mean_diagonal(scratch_.rows, scratch_.system), has_stiffness_);
        regularise(scratch_.rows, regularisation, factor, drive_scale_.value(), scratch_.system);
        take(scratch_.system.solve(scratch_.rows));
        return {scratch_.system.work(), scratch_.system.is_active_set_unconverged()};
    }
    void solve_with_last_factor() {
        gather_residuals(scratch_);
        take(scratch_.system.solve_with_last_factor(scratch_.values));
    }
    double longest_move() const { return handhold::longest_move(scratch_); }
    double largest_rotation() const { return largest_rotation_; }
    double apply_moves(double scale) { return handhold::apply_moves(island_, scale, scratch_); }

  private:
    // True if the number of rows is unchanged and all are bilateral.
    bool has_same_rows() const {
        return scratch_.rows.size() == scratch_.previous_rows.size() &&
               std::ranges::none_of(scratch_.rows, [](const Row& row) { return row.unilateral; });
    }
    void collect() {
        std::swap(scratch_.rows, scratch_.previous_rows);
        collect_rows(island_, scratch_.rows);
    }
    // True if every row is a point row, now and after a step.
    bool has_only_point_rows() const {
        if (has_unilateral_block(island_)) {
            return false;
        }
        for (std::size_t i = 0; i < scratch_.rows.size(); i += 3) {
            if (!starts_point_rows(scratch_.rows[i])) {
                return false;
            }
        }
        return true;
    }
    void update_point_residuals() {
        for (std::size_t i = 0; i < scratch_.rows.size(); i += 3) {
            const Vec3 error = point_error(island_.bodies, island_.blocks[scratch_.rows[i].block]);
            for (std::size_t axis = 0; axis < 3; ++axis) {
                scratch_.rows[i + axis].residual = error[static_cast<Eigen::Index>(axis)];
            }
        }
    }
    void take(std::span<const double> lambda) {
        largest_rotation_ = gather_moves(scratch_.system.moves(), scratch_);
        scratch_.lambda.assign(lambda.begin(), lambda.end());
    }

    const IslandView& island_;
    SolveScratch& scratch_;
    DriveScale drive_scale_;
    double largest_rotation_ = 0.0;
    bool has_stiffness_ = false;
    bool has_only_point_rows_ = false;
    bool reuses_jacobian_ = false;
};

// --- Packed triads -------------------------------------------------------------------------------

// The step of an island solved by TriadSystem: bilateral rows only.
class TriadSteps {
  public:
    static constexpr bool k_has_cheap_factor = true;

    TriadSteps(const IslandView& island, TriadSystem& system) : island_(island), system_(system) {}

    StepErrors evaluate(bool /*was_whole*/) {
        system_.evaluate(island_);
        return {.worst_m = system_.worst_residual(),
                .worst_drive_m = system_.worst_drive_residual(),
                .keeps_factor = true};
    }
    void prepare(const StepHints& hints) {
        if (hints.min_move_m) {
            system_.restrict_to_active(*hints.min_move_m);
        } else {
            system_.activate_all_rows();
        }
        if (hints.adds_stiffness) {
            system_.gather_stiffness();
        } else {
            system_.clear_stiffness();
        }
    }
    StepWork solve(const Regularisation& regularisation, double factor) {
        system_.factorise(regularisation, factor);
        system_.solve();
        return {};
    }
    void solve_with_last_factor() { system_.solve(); }
    double longest_move() const { return system_.longest_move(); }
    double largest_rotation() const { return system_.largest_rotation(); }
    double apply_moves(double scale) { return system_.apply_moves(scale); }

  private:
    const IslandView& island_;
    TriadSystem& system_;
};

// --- Newton's method ---------------------------------------------------------------------------

struct StepResult {
    double length_m = 0.0;
    bool is_whole = true;  // not scaled down
    StepWork work;
};

// One Newton step. If the step would be scaled below min_step_scale, it is repeated with more
// regularisation.
template <NewtonStep Steps>
StepResult take_step(const Regularisation& regularisation, const StepControl& schedule,
                     const StepErrors& errors, Steps& steps) {
    const double worst_m = errors.worst_m;
    StepResult result;
    double factor = 1.0;
    double scale = 1.0;
    for (int attempt = 0; attempt <= k_max_regularisation_retries; ++attempt) {
        result.work = steps.solve(regularisation, factor);
        const double turn = std::max(steps.largest_rotation(), 1e-30);
        const double move = std::max(steps.longest_move(), 1e-30);
        const double largest = errors.has_contact
                                   ? k_max_move_ratio * worst_m
                                   : std::max(k_max_joint_move_ratio * worst_m, k_unlimited_move_m);
        scale = std::min({1.0, schedule.max_step_rotation_rad / turn, largest / move});
        if (scale >= schedule.min_step_scale) {
            break;
        }
        factor *= k_retry_regularisation_increase;
    }
    result.length_m = steps.apply_moves(scale);
    result.is_whole = scale == 1.0;
    return result;
}

// Takes a step with the previous factor, which is as good as a new one if the poses hardly moved
// since.
template <FactorisedStep Steps>
void repeat_step(Steps& steps, StepResult& result) {
    steps.solve_with_last_factor();
    result.length_m = steps.apply_moves(1.0);
    result.is_whole = true;
}

// True if the next step may reuse the last step's factor: the last step left at most
// k_max_step_ratio of the error. If a new factor costs little more than a step (`is_factor_cheap`),
// the factor is reused only for a step that is expected to be the last.
bool is_good_step(double residual_m, double previous_m, bool is_factor_cheap,
                  const NewtonSettings& settings) {
    constexpr double k_max_step_ratio = 0.05;
    constexpr double k_safety = 0.1;  // a repeated step converges slightly worse
    const double ratio = residual_m / previous_m;
    return residual_m < settings.geometric_stiffness_from_m && ratio < k_max_step_ratio &&
           (!is_factor_cheap || ratio * residual_m < k_safety * settings.tolerance_m);
}

// Ends when the error has converged, when the last step was short, when the work or the iterations
// are spent, or after a step that leaves more than `stall_ratio` of the smallest error so far.
template <NewtonStep Steps>
NewtonResult iterate(const IslandView& island, const NewtonSettings& settings, double stall_ratio,
                     Steps& steps) {
    NewtonResult result;
    Regularisation regularisation = settings.regularisation;
    double previous = std::numeric_limits<double>::infinity();
    double previous_overlap = previous;
    double smallest = previous;
    StepResult step{previous, false, {}};
    SteadyDecrease steady(settings.schedule);
    bool refines_drives = false;  // the next (or last) step only reduces the drives' errors
    for (;;) {
        const StepErrors errors = steps.evaluate(step.is_whole);
        result.residual_m = errors.worst_m;
        result.converged = result.residual_m < settings.tolerance_m;
        const bool is_stalled = result.iterations > 0 && result.residual_m > stall_ratio * smallest;
        if (result.iterations == 0) {
            result.initial_drive_error_m = errors.worst_drive_m;
        }
        refines_drives = result.converged && !refines_drives && step.is_whole &&
                         errors.keeps_factor && result.iterations + 1 < settings.max_iterations &&
                         errors.worst_drive_m > k_drive_tolerance_ratio * settings.tolerance_m;
        result.work = step.work.spent;
        result.out_of_work = !result.converged && result.work >= island.max_work;
        if ((result.converged && !refines_drives) || result.iterations == settings.max_iterations ||
            step.length_m < settings.step_tolerance_m || result.out_of_work || is_stalled) {
            return result;
        }
        bool repeats = false;
        if constexpr (FactorisedStep<Steps>) {
            repeats = refines_drives || (step.is_whole && errors.keeps_factor &&
                                         is_good_step(result.residual_m, previous,
                                                      Steps::k_has_cheap_factor, settings));
            if (result.iterations > 0 && !repeats) {
                // While each step halves the error, the next step skips the bodies that the last
                // one hardly moved.
                const bool halves = step.is_whole && result.residual_m < 0.5 * previous;
                steps.prepare(
                    {.adds_stiffness = result.residual_m > settings.geometric_stiffness_from_m,
                     .min_move_m = halves
                                       ? std::optional(k_inactive_move_ratio * settings.tolerance_m)
                                       : std::nullopt});
            }
        }
        if (result.iterations > 0 && !repeats) {
            const bool is_steady = steady.take({.residual_m = result.residual_m,
                                                .smallest_residual_m = smallest,
                                                .is_unscaled = step.is_whole,
                                                .has_contact = errors.has_contact});
            update_regularisation(result.residual_m < 0.5 * smallest || is_steady, errors.overlap_m,
                                  previous_overlap, settings, regularisation);
        }
        if constexpr (FactorisedStep<Steps>) {
            if (repeats) {
                repeat_step(steps, step);
            }
        }
        if (!repeats) {
            step = take_step(regularisation, settings.schedule, errors, steps);
        }
        result.active_set_unconverged |= step.work.is_active_set_unconverged;
        previous = result.residual_m;
        smallest = std::min(smallest, previous);
        previous_overlap = errors.overlap_m;
        ++result.iterations;
    }
}

constexpr double k_never_stalls = std::numeric_limits<double>::infinity();

NewtonResult iterate_triads(const IslandView& island, const NewtonSettings& settings,
                            TriadSystem& triads) {
    TriadSteps steps(island, triads);
    NewtonResult result = iterate(island, settings, k_never_stalls, steps);
    result.joints = triads.worst_joints();
    return result;
}

// Solves from the bodies' current poses, which may have changed since the island was loaded.
NewtonResult solve_load_step(const IslandView& island, const NewtonSettings& settings,
                             SolveScratch& scratch) {
    if (!scratch.triads.load(island)) {
        return {};
    }
    const NewtonResult result = iterate_triads(island, settings, scratch.triads);
    scratch.triads.store_poses(island);
    return result;
}

NewtonResult solve_triads(const IslandView& island, const NewtonSettings& settings,
                          SolveScratch& scratch) {
    const NewtonResult full_load = iterate_triads(island, settings, scratch.triads);
    reserve_load_stepping(island, scratch);
    const bool steps_load =
        needs_load_stepping(full_load, settings) && scratch.load_stepped.take(island);
    scratch.triads.store_poses(island);
    return steps_load
               ? solve_by_load_stepping(island, settings, full_load, scratch, &solve_load_step)
               : full_load;
}

NewtonResult solve_rows(const IslandView& island, const NewtonSettings& settings,
                        SolveScratch& scratch) {
    RowSteps steps(island, scratch);
    return iterate(island, settings, k_never_stalls, steps);
}

NewtonResult solve_heap(const IslandView& island, const NewtonSettings& settings,
                        SolveScratch& scratch) {
    NewtonSettings of_heap = settings;
    of_heap.max_iterations = std::min(settings.max_iterations, SweepSteps::k_max_iterations);
    SweepSteps steps(island, settings.tolerance_m, scratch);
    return iterate(island, of_heap, SweepSteps::k_stall_ratio, steps);
}

}  // namespace

NewtonResult solve_positions(const IslandView& island, const NewtonSettings& settings,
                             SolveScratch& scratch) {
    const FlushDenormals flush;
    const auto solve = [&] {
        if (island.is_heap) {
            return solve_heap(island, settings, scratch);
        }
        return scratch.triads.load(island) ? solve_triads(island, settings, scratch)
                                           : solve_rows(island, settings, scratch);
    };
    const NewtonResult result = solve();
    drop_negligible(island);
    return result;
}

}  // namespace handhold

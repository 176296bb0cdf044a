// Solver, newton: the active set of unilateral rows.
// Sources: block principal pivoting of Judice and Pires (1994); if pivoting cycles, the active-set
// descent of Lawson and Hanson, Solving Least Squares Problems (1974), which cannot cycle.
#include "engine/solver/newton/active_set.hpp"

#include <algorithm>
#include <utility>

namespace handhold {
namespace {

constexpr std::uint8_t k_undecided = 2;  // becomes active in the first solve if it overlaps
// Consecutive block pivots that do not reduce the number of violating rows, before descent takes
// over.
constexpr int k_max_block_pivots = 4;
constexpr int k_max_descent_steps = 60;  // limit of factorisations in the descent
constexpr double k_overlap_m = 1e-10;
constexpr double k_noise_m = 1e-8;

}  // namespace

void RowSystem::assemble(std::span<const SolverBody> bodies,
                         std::span<const Mat3> inverse_inertia_ws, std::span<const Row> rows) {
    matrix_.assemble(bodies, inverse_inertia_ws, rows);
    lambda_.assign(rows.size(), 0.0);
    values_.resize(rows.size());
    chosen_.resize(rows.size());
    warm_start_active_set(rows);
    fixed_.assign(rows.size(), 0);
    fixed_lambda_.assign(rows.size(), 0.0);
}

// Both key lists are sorted by block, so one pass merges them.
void RowSystem::warm_start_active_set(std::span<const Row> rows) {
    std::swap(keys_, previous_keys_);
    std::swap(active_, previous_active_);
    keys_.clear();
    active_.clear();
    std::size_t before = 0;
    for (const Row& row : rows) {
        const std::uint64_t block = std::uint64_t{row.block} << 32U;
        const bool is_first = keys_.empty() || keys_.back() < block;
        keys_.push_back(is_first ? block : keys_.back() + 1);
        while (before < previous_keys_.size() && previous_keys_[before] < keys_.back()) {
            ++before;
        }
        const bool is_known =
            before < previous_keys_.size() && previous_keys_[before] == keys_.back();
        // Warm start: rows that were active before start active.
        active_.push_back(!row.unilateral ? 1 : is_known ? previous_active_[before] : k_undecided);
    }
}

void RowSystem::fix_multiplier(std::size_t row, double lambda) {
    fixed_[row] = 1;
    fixed_lambda_[row] = lambda;
}

void RowSystem::free_multiplier(std::size_t row) {
    fixed_[row] = 0;
    fixed_lambda_[row] = 0.0;
}

double RowSystem::remaining_residual(std::size_t row, double value) const {
    return value + matrix_.row_motion(row);
}

// True if a unilateral row violates complementarity: it is active and pulls (lambda < 0), or it is
// inactive and the solution would make it overlap.
bool RowSystem::violates_complementarity(const Row& row, std::size_t index) const {
    if (!row.unilateral || fixed_[index] != 0) {
        return false;
    }
    if (active_[index] != 0) {
        return lambda_[index] < 0.0;
    }
    return remaining_residual(index, row.residual) < -k_overlap_m;
}

void RowSystem::solve_active() {
    for (std::size_t i = 0; i < size(); ++i) {
        chosen_[i] = is_active(i) ? 1 : 0;
    }
    matrix_.factorise(chosen_);
    work_ += 1 + matrix_.factorisation_cost() / WorkBudget::k_multiply_adds;
    matrix_.solve(values_, lambda_);
    for (std::size_t i = 0; i < size(); ++i) {
        lambda_[i] = fixed_[i] != 0 ? fixed_lambda_[i] : lambda_[i];
    }
    matrix_.gather_moves(lambda_);
}

std::span<const double> RowSystem::solve(std::span<const Row> rows) {
    // Adds the effect of rows with a fixed multiplier to the residuals of the others.
    const bool has_fixed =
        std::ranges::any_of(fixed_, [](std::uint8_t is_fixed) { return is_fixed != 0; });
    if (has_fixed) {
        matrix_.gather_moves(fixed_lambda_);
    }
    for (std::size_t i = 0; i < size(); ++i) {
        values_[i] = rows[i].residual + (has_fixed ? matrix_.row_motion(i) : 0.0);
        if (active_[i] == k_undecided) {
            active_[i] = values_[i] < 0.0 ? 1 : 0;
        }
    }
    active_set_unconverged_ = !block_pivot(rows) && !descend_active_set(rows);
    return lambda_;
}

// Changes all violating rows at once until none is left. False if the number of violating rows
// stops decreasing.
bool RowSystem::block_pivot(std::span<const Row> rows) {
    std::size_t min_violations = size() + 1;
    for (int blocks_left = k_max_block_pivots; blocks_left > 0 && !is_out_of_work();) {
        solve_active();
        violating_rows_.clear();
        for (std::uint32_t i = 0; i < size(); ++i) {
            if (violates_complementarity(rows[i], i)) {
                violating_rows_.push_back(i);
            }
        }
        if (violating_rows_.empty()) {
            return true;
        }
        if (violating_rows_.size() < min_violations) {
            min_violations = violating_rows_.size();
            blocks_left = k_max_block_pivots;
        } else {
            --blocks_left;
        }
        for (const std::uint32_t i : violating_rows_) {
            active_[i] ^= 1U;
        }
    }
    return false;
}

// Shortens feasible_lambda_ where a multiplier was cut off at 0 without its counterparts, so that
// the rest would throw the bodies: if q > 0 (descend_active_set), scales it to the least q on the
// line to 0. Fixed multipliers stay; values_ contains their effect.
void RowSystem::shorten_unbalanced() {
    for (std::size_t i = 0; i < size(); ++i) {
        lambda_[i] = fixed_[i] != 0 ? 0.0 : feasible_lambda_[i];
    }
    matrix_.gather_moves(lambda_);
    const std::span<const double> alpha = std::as_const(matrix_).alpha();
    double slope = 0.0;
    double curvature = 0.0;  // q(t lambda) = t slope + t^2 curvature / 2
    for (std::size_t i = 0; i < size(); ++i) {
        slope += lambda_[i] * values_[i];
        curvature += lambda_[i] * (matrix_.row_motion(i) + alpha[i] * lambda_[i]);
    }
    if (slope + 0.5 * curvature <= 0.0) {
        return;
    }
    const double scale = std::max(0.0, -slope / curvature);
    for (std::size_t i = 0; i < size(); ++i) {
        feasible_lambda_[i] = fixed_[i] != 0 ? fixed_lambda_[i] : scale * lambda_[i];
    }
}

// Active-set descent from a feasible point (no multiplier pulls). Each step decreases
//   q(lambda) = 1/2 lambda^T A lambda + residual^T lambda,   A = J W J^T + R
// so that no active set occurs twice. If the steps or the work run out, the last feasible point is
// kept. It has q <= 0, as the start has (shorten_unbalanced): its moves are no larger than the
// residuals justify. Overlapping rows are activated all at once or, if that made no progress, only
// the deepest.
// Returns true if the minimum was found, up to rounding noise: the deepest row became inactive
// again as soon as it was activated, and no row overlaps by more than k_noise_m.
bool RowSystem::descend_active_set(std::span<const Row> rows) {
    feasible_lambda_.assign(lambda_.begin(), lambda_.end());
    for (std::size_t i = 0; i < size(); ++i) {
        if (rows[i].unilateral && fixed_[i] == 0) {
            feasible_lambda_[i] = active_[i] != 0 ? std::max(0.0, feasible_lambda_[i]) : 0.0;
            active_[i] = feasible_lambda_[i] > 0.0 ? 1 : 0;
        }
    }
    shorten_unbalanced();
    bool moves = true;
    bool activated_one = false;
    for (int step = 0; step < k_max_descent_steps && !is_out_of_work(); ++step) {
        solve_active();
        const Approach approach = step_towards_solution(rows);
        moves = moves || approach.moves;
        if (!approach.reaches_solution) {
            continue;
        }
        if (activated_one && !moves) {
            return worst_remaining_residual(rows) > -k_noise_m;
        }
        activated_one = !moves;
        if (!activate_overlapping(rows, activated_one)) {
            return true;
        }
        moves = false;
    }
    lambda_.assign(feasible_lambda_.begin(), feasible_lambda_.end());
    matrix_.gather_moves(lambda_);
    return false;
}

// Moves the feasible point towards lambda until a row would start to pull; that row becomes
// inactive.
RowSystem::Approach RowSystem::step_towards_solution(std::span<const Row> rows) {
    // > 1: no row limits the step; a row that would pull limits it to 1 or less
    constexpr double k_full_step = 2.0;
    const auto step_length_of = [&](std::size_t i) {
        const bool pulls = rows[i].unilateral && is_active(i) && lambda_[i] < 0.0;
        return pulls ? feasible_lambda_[i] / (feasible_lambda_[i] - lambda_[i]) : k_full_step;
    };
    double step_length = k_full_step;
    for (std::size_t i = 0; i < size(); ++i) {
        step_length = std::min(step_length, step_length_of(i));
    }
    Approach approach{step_length == k_full_step};
    for (std::size_t i = 0; i < size(); ++i) {
        const double before = feasible_lambda_[i];
        if (approach.reaches_solution) {
            feasible_lambda_[i] = lambda_[i];
        } else if (step_length_of(i) <= step_length) {
            feasible_lambda_[i] = 0.0;
            active_[i] = 0;
        } else {
            feasible_lambda_[i] += step_length * (lambda_[i] - feasible_lambda_[i]);
        }
        approach.moves = approach.moves || feasible_lambda_[i] != before;
    }
    return approach;
}

// Deepest overlap of all inactive rows, negative; 0 if none overlaps.
double RowSystem::worst_remaining_residual(std::span<const Row> rows) const {
    double worst = 0.0;
    for (std::size_t i = 0; i < size(); ++i) {
        if (rows[i].unilateral && fixed_[i] == 0 && active_[i] == 0) {
            worst = std::min(worst, remaining_residual(i, rows[i].residual));
        }
    }
    return worst;
}

// Activates inactive rows that overlap: all of them or only the deepest. True if there were any.
bool RowSystem::activate_overlapping(std::span<const Row> rows, bool only_worst) {
    violating_rows_.clear();
    double worst = 0.0;
    for (std::uint32_t i = 0; i < size(); ++i) {
        if (active_[i] != 0 || !violates_complementarity(rows[i], i)) {
            continue;
        }
        const double rest = remaining_residual(i, rows[i].residual);
        if (only_worst && rest < worst) {
            violating_rows_.clear();
        }
        if (!only_worst || rest < worst) {
            violating_rows_.push_back(i);
            worst = std::min(worst, rest);
        }
    }
    for (const std::uint32_t i : violating_rows_) {
        active_[i] = 1;
    }
    return !violating_rows_.empty();
}

std::span<const double> RowSystem::solve_with_last_factor(std::span<const double> values) {
    matrix_.solve(values, lambda_);
    matrix_.gather_moves(lambda_);
    return lambda_;
}

}  // namespace handhold

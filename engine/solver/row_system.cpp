// Sources: active set: block principal pivoting of Judice and Pires (1994), whose steps of one row,
// after Murty (1974), end it where changing all wrong rows at once goes round in a circle.
#include "engine/solver/row_system.hpp"

#include <algorithm>

namespace handhold {
namespace {

constexpr int k_active_set_changes = 40;  // three or four do nearly always
// Murty's steps of one row take as many as there are rows: for larger sets there is no waiting.
constexpr std::ptrdiff_t k_small_set = 96;
constexpr std::uint8_t k_undecided = 2;  // acts in the first solve where it overlaps
constexpr int k_drops = 6;               // of all pulling rows at once
constexpr int k_block_changes = 3;  // of all wrong rows at once that may fail to make them fewer

}  // namespace

void RowSystem::assemble(std::span<const SolverBody> bodies,
                         std::span<const Mat3> inverse_inertia_ws, std::span<const Row> rows) {
    matrix_.assemble(bodies, inverse_inertia_ws, rows);
    lambda_.assign(rows.size(), 0.0);
    values_.resize(rows.size());
    chosen_.resize(rows.size());
    take_over_active_set(rows);
    held_.assign(rows.size(), 0);
    held_lambda_.assign(rows.size(), 0.0);
}

// Both lists are in the order of their blocks.
void RowSystem::take_over_active_set(std::span<const Row> rows) {
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
        // What acted in the rows before acts at first.
        active_.push_back(!row.unilateral ? 1 : is_known ? previous_active_[before] : k_undecided);
    }
}

void RowSystem::hold(std::size_t row, double lambda) {
    held_[row] = 1;
    held_lambda_[row] = lambda;
}

void RowSystem::release(std::size_t row) {
    held_[row] = 0;
    held_lambda_[row] = 0.0;
}

double RowSystem::remainder(std::size_t row, double value) const {
    return value + matrix_.row_motion(row);
}

// A unilateral row is wrong where it acts and pulls, or is left out and the solution would overlap
// it.
bool RowSystem::is_wrong(const Row& row, std::size_t index) const {
    constexpr double k_overlap = 1e-10;
    if (!row.unilateral || held_[index] != 0) {
        return false;
    }
    if (active_[index] != 0) {
        return lambda_[index] < 0.0;
    }
    return remainder(index, row.value_m) < -k_overlap;
}

void RowSystem::solve_active() {
    for (std::size_t i = 0; i < size(); ++i) {
        chosen_[i] = is_active(i) ? 1 : 0;
    }
    matrix_.factorise(chosen_);
    matrix_.solve(values_, lambda_);
    for (std::size_t i = 0; i < size(); ++i) {
        lambda_[i] = held_[i] != 0 ? held_lambda_[i] : lambda_[i];
    }
    matrix_.gather_moves(lambda_);
}

std::span<const double> RowSystem::solve(std::span<const Row> rows) {
    // What the held rows do to the others.
    const bool holds = std::ranges::any_of(held_, [](std::uint8_t held) { return held != 0; });
    if (holds) {
        matrix_.gather_moves(held_lambda_);
    }
    for (std::size_t i = 0; i < size(); ++i) {
        values_[i] = rows[i].value_m + (holds ? matrix_.row_motion(i) : 0.0);
        if (active_[i] == k_undecided) {
            active_[i] = values_[i] < 0.0 ? 1 : 0;
        }
    }
    is_unsettled_ = !find_active_set(rows);
    if (is_unsettled_) {
        leave_out_pulling(rows);
    }
    return lambda_;
}

// True where every acting row pushes and no other overlaps.
bool RowSystem::find_active_set(std::span<const Row> rows) {
    const bool is_small = std::ranges::count_if(rows, &Row::unilateral) <= k_small_set;
    std::size_t fewest = size() + 1;
    int blocks_left = k_block_changes;
    for (int change = 0; change < k_active_set_changes; ++change) {
        solve_active();
        wrong_rows_.clear();
        for (std::uint32_t i = 0; i < size(); ++i) {
            if (is_wrong(rows[i], i)) {
                wrong_rows_.push_back(i);
            }
        }
        if (wrong_rows_.empty()) {
            return true;
        }
        if (wrong_rows_.size() < fewest) {
            fewest = wrong_rows_.size();
            blocks_left = k_block_changes;
        } else if (blocks_left > 0) {
            --blocks_left;
        } else if (is_small) {
            wrong_rows_.assign(1, wrong_rows_.back());
        } else {
            return false;
        }
        for (const std::uint32_t i : wrong_rows_) {
            active_[i] ^= 1U;
        }
    }
    solve_active();
    return false;
}

// Without an active set: what pulls is left out for good. What that overlaps is the next step's.
void RowSystem::leave_out_pulling(std::span<const Row> rows) {
    for (int drop = 0; drop < k_drops; ++drop) {
        bool pulls = false;
        for (std::size_t i = 0; i < size(); ++i) {
            if (rows[i].unilateral && is_active(i) && lambda_[i] < 0.0) {
                active_[i] = 0;
                pulls = true;
            }
        }
        if (!pulls) {
            return;
        }
        solve_active();
    }
    for (std::size_t i = 0; i < size(); ++i) {
        lambda_[i] = rows[i].unilateral && is_active(i) ? std::max(0.0, lambda_[i]) : lambda_[i];
    }
    matrix_.gather_moves(lambda_);
}

std::span<const double> RowSystem::solve_again(std::span<const double> values) {
    matrix_.solve(values, lambda_);
    matrix_.gather_moves(lambda_);
    return lambda_;
}

}  // namespace handhold

// Solver, sweeps: projected Gauss-Seidel. The equations are in the header.
#include "engine/solver/sweeps/row_sweeps.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

#include "engine/core/disjoint_sets.hpp"

namespace handhold {
namespace {

// Limits of the condensed responses: twists stored, and twists times exact rows as a measure of the
// work to compute them. Beyond these limits, the exact rows are solved after every sweep instead.
constexpr std::size_t k_max_responses = 50'000;
constexpr std::size_t k_max_response_work = 2'000'000;

using Twist = RowMatrix::Twist;

// Two doubles per instruction with SSE2 and NEON. Without, sums have the same order.
using Double2 = double __attribute__((vector_size(16), aligned(8)));
Double2 load2(const double* from) {
    Double2 pair;
    std::memcpy(&pair, from, sizeof pair);
    return pair;
}

Double2 dot2(const std::array<double, 6>& x, const Twist& y) {
    return load2(x.data()) * load2(y.data()) + load2(&x[2]) * load2(&y[2]) +
           load2(&x[4]) * load2(&y[4]);
}
double dot(const std::array<double, 6>& x, const Twist& y) {
    const Double2 sum = dot2(x, y);
    return sum[0] + sum[1];
}

void add_scaled(const std::array<double, 6>& x, double factor, Twist& out) {
    for (std::size_t c = 0; c < 6; c += 2) {
        const Double2 sum = load2(&out[c]) + factor * load2(&x[c]);
        std::memcpy(&out[c], &sum, sizeof sum);
    }
}

std::array<double, 6> stacked(const Vec3& linear, const Vec3& angular) {
    return {linear.x(), linear.y(), linear.z(), angular.x(), angular.y(), angular.z()};
}

}  // namespace

void RowSweeps::assemble(std::span<const SolverBody> bodies,
                         std::span<const Mat3> inverse_inertia_ws, std::span<const Row> rows,
                         std::span<const BoundedRows> bounded) {
    work_ = 0;
    group_rows(bodies, rows, bounded);
    if (!exact_rows_.empty()) {
        exact_.assemble(bodies, inverse_inertia_ws, exact_rows_);
    }
    moves_.assign(inverse_inertia_ws.size() + 1, Twist{});
    pack_rows(bodies, inverse_inertia_ws, rows);
    find_clusters();
    alpha_.assign(rows.size(), 0.0);
    lambda_.assign(rows.size(), 0.0);
}

void RowSweeps::group_rows(std::span<const SolverBody> bodies, std::span<const Row> rows,
                           std::span<const BoundedRows> bounded) {
    kinds_.clear();
    groups_.clear();
    exact_rows_.clear();
    exact_indices_.clear();
    for (const Row& row : rows) {
        kinds_.push_back(row.unilateral ? Kind::unilateral : Kind::exact);
    }
    for (const BoundedRows& bound : bounded) {
        std::fill_n(kinds_.begin() + static_cast<std::ptrdiff_t>(bound.row), bound.width,
                    Kind::bounded);
    }
    const auto is_stiff = [&](const Row& row) {
        return std::ranges::any_of(std::array{row.a, row.b}, [&](std::uint32_t i) {
            return bodies[i].inverse_mass > 0.0 && !bodies[i].in_heap;
        });
    };
    std::size_t next = 0;
    for (std::uint32_t i = 0; i < rows.size(); ++i) {
        if (kinds_[i] == Kind::exact) {
            exact_rows_.push_back(rows[i]);
            exact_indices_.push_back(i);
        } else if (kinds_[i] == Kind::unilateral) {
            groups_.push_back({i, 1, true, is_stiff(rows[i]), {}});
        } else if (next < bounded.size() && bounded[next].row == i) {
            groups_.push_back({i, static_cast<std::uint32_t>(bounded[next].width), false,
                               is_stiff(rows[i]), bounded[next]});
            ++next;
        }
    }
}

void RowSweeps::pack_rows(std::span<const SolverBody> bodies,
                          std::span<const Mat3> inverse_inertia_ws, std::span<const Row> rows) {
    const auto fixed_slot = static_cast<std::uint32_t>(inverse_inertia_ws.size());
    packed_.assign(rows.size(), {});
    diagonal_.resize(rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const Row& row = rows[i];
        PackedRow& packed = packed_[i];
        packed.slot_a = packed.slot_b = fixed_slot;
        if (const SolverBody& a = bodies[row.a]; a.inverse_mass > 0.0) {
            packed.slot_a = a.slot;
            packed.jacobian_a = stacked(row.linear_a, row.angular_a);
            packed.response_a =
                stacked(a.inverse_mass * row.linear_a, inverse_inertia_ws[a.slot] * row.angular_a);
        }
        if (const SolverBody& b = bodies[row.b]; b.inverse_mass > 0.0) {
            packed.slot_b = b.slot;
            packed.jacobian_b = stacked(-row.linear_a, row.angular_b);
            packed.response_b =
                stacked(-b.inverse_mass * row.linear_a, inverse_inertia_ws[b.slot] * row.angular_b);
        }
        diagonal_[i] =
            dot(packed.jacobian_a, packed.response_a) + dot(packed.jacobian_b, packed.response_b);
    }
}

void RowSweeps::find_clusters() {
    const std::size_t slots = moves_.size();
    cluster_of_slot_.resize(slots);
    std::iota(cluster_of_slot_.begin(), cluster_of_slot_.end(), 0U);
    is_exact_body_.assign(slots, 0);
    const auto fixed_slot = static_cast<std::uint32_t>(slots - 1);
    for (const std::uint32_t i : exact_indices_) {
        const PackedRow& row = packed_[i];
        is_exact_body_[row.slot_a] = is_exact_body_[row.slot_b] = 1;
        if (row.slot_a != fixed_slot && row.slot_b != fixed_slot) {
            const std::uint32_t a = find_root(cluster_of_slot_, row.slot_a);
            const std::uint32_t b = find_root(cluster_of_slot_, row.slot_b);
            cluster_of_slot_[std::max(a, b)] = std::min(a, b);
        }
    }
    is_exact_body_[fixed_slot] = 0;
    cluster_size_.assign(slots, 0);
    for (std::uint32_t slot = 0; slot < slots; ++slot) {
        cluster_of_slot_[slot] = find_root(cluster_of_slot_, slot);
        ++cluster_size_[cluster_of_slot_[slot]];
    }
    cluster_begin_.resize(slots);
    std::exclusive_scan(cluster_size_.begin(), cluster_size_.end(), cluster_begin_.begin(), 0U);
    cluster_slots_.resize(slots);
    std::ranges::fill(cluster_size_, 0U);
    for (std::uint32_t slot = 0; slot < slots; ++slot) {
        const std::uint32_t cluster = cluster_of_slot_[slot];
        cluster_slots_[cluster_begin_[cluster] + cluster_size_[cluster]++] = slot;
    }
}

bool RowSweeps::may_condense() const {
    std::size_t responses = 0;
    for (const Group& group : groups_) {
        for (std::uint32_t i = group.row; i < group.row + group.width; ++i) {
            for (const std::uint32_t slot : {packed_[i].slot_a, packed_[i].slot_b}) {
                responses += is_exact_body_[slot] != 0 ? cluster_size_[cluster_of_slot_[slot]] : 0;
            }
        }
    }
    return responses <= k_max_responses && responses * exact_rows_.size() <= k_max_response_work;
}

// Writes the responses of a row with a body that has exact rows.
void RowSweeps::respond(PackedRow& row) {
    const std::span<Twist> moves = exact_.edit_moves();
    std::ranges::fill(moves, Twist{});
    const auto fixed_slot = static_cast<std::uint32_t>(moves_.size() - 1);
    for (const bool is_a : {true, false}) {
        const std::uint32_t slot = is_a ? row.slot_a : row.slot_b;
        if (slot != fixed_slot) {
            add_scaled(is_a ? row.response_a : row.response_b, 1.0, moves[slot]);
        }
    }
    for (std::size_t i = 0; i < exact_rows_.size(); ++i) {
        exact_values_[i] = exact_.row_motion(i);
    }
    exact_.solve(exact_values_, exact_lambda_);
    exact_.gather_moves(exact_lambda_);
    row.responses_begin = static_cast<std::uint32_t>(responses_.size());
    const auto respond_with = [&](std::uint32_t slot) {
        Twist move = exact_.moves()[slot];
        if (slot == row.slot_a) {
            add_scaled(row.response_a, 1.0, move);
        }
        if (slot == row.slot_b) {
            add_scaled(row.response_b, 1.0, move);
        }
        responses_.push_back({slot, move});
    };
    const std::uint32_t cluster_a = cluster_of_slot_[row.slot_a];
    for (const std::uint32_t of : {row.slot_a, row.slot_b}) {
        const std::uint32_t cluster = cluster_of_slot_[of];
        if (of == fixed_slot || (of == row.slot_b && row.slot_a != of && cluster == cluster_a)) {
            continue;
        }
        const std::span<const std::uint32_t> slots(&cluster_slots_[cluster_begin_[cluster]],
                                                   cluster_size_[cluster]);
        std::ranges::for_each(slots, respond_with);
    }
    row.responses_end = static_cast<std::uint32_t>(responses_.size());
}

void RowSweeps::factorise() {
    chosen_.assign(exact_rows_.size(), 1);
    exact_values_.resize(exact_rows_.size());
    exact_lambda_.resize(exact_rows_.size());
    for (std::size_t i = 0; i < exact_rows_.size(); ++i) {
        exact_.alpha()[i] = alpha_[exact_indices_[i]];
    }
    if (!exact_rows_.empty()) {
        exact_.factorise(chosen_);
    }
    responses_.clear();
    is_condensed_ = may_condense();
    sweep_work_ = stiff_work_ = 0;
    for (const Group& group : groups_) {
        for (std::uint32_t i = group.row; i < group.row + group.width; ++i) {
            PackedRow& row = packed_[i];
            row.responses_begin = row.responses_end = 0;
            double diagonal = diagonal_[i];
            const bool is_coupled =
                is_exact_body_[row.slot_a] != 0 || is_exact_body_[row.slot_b] != 0;
            if (is_condensed_ && is_coupled) {
                respond(row);
                work_ += exact_rows_.size();
                diagonal = 0.0;
                for (std::uint32_t r = row.responses_begin; r < row.responses_end; ++r) {
                    const Response& response = responses_[r];
                    diagonal +=
                        response.slot == row.slot_a ? dot(row.jacobian_a, response.move) : 0.0;
                    diagonal +=
                        response.slot == row.slot_b ? dot(row.jacobian_b, response.move) : 0.0;
                }
            }
            const std::uint64_t work = 1 + (row.responses_end - row.responses_begin) / 4;
            sweep_work_ += work;
            stiff_work_ += group.is_stiff ? work : 0;
            // A row whose bodies the exact rows hold still cannot be moved: its diagonal is a
            // difference of two nearly equal numbers, so it counts as 0.
            constexpr double k_least_share = 1e-9;
            row.inverse_diagonal =
                diagonal > k_least_share * diagonal_[i] ? 1.0 / (diagonal + alpha_[i]) : 0.0;
        }
    }
}

double RowSweeps::motion_of(const PackedRow& row) const {
    const Double2 sum =
        dot2(row.jacobian_a, moves_[row.slot_a]) + dot2(row.jacobian_b, moves_[row.slot_b]);
    return sum[0] + sum[1];
}

void RowSweeps::push(const PackedRow& row, double impulse) {
    if (row.responses_begin == row.responses_end) {
        add_scaled(row.response_a, impulse, moves_[row.slot_a]);
        add_scaled(row.response_b, impulse, moves_[row.slot_b]);
        return;
    }
    for (std::uint32_t i = row.responses_begin; i < row.responses_end; ++i) {
        add_scaled(responses_[i].move, impulse, moves_[responses_[i].slot]);
    }
}

// Makes one Gauss-Seidel step for a group. Returns the largest change of the group's residuals.
double RowSweeps::visit(const Group& group) {
    if (group.is_unilateral) {  // one row: a contact or a limit
        const PackedRow& packed = packed_[group.row];
        double& lambda = lambda_[group.row];
        const double residual = values_[group.row] + motion_of(packed) + alpha_[group.row] * lambda;
        const double change = std::max(lambda - residual * packed.inverse_diagonal, 0.0) - lambda;
        if (change == 0.0) {
            return 0.0;
        }
        lambda += change;
        push(packed, change);
        return std::abs(change) * diagonal_[group.row];
    }
    std::array<double, 3> wanted{};
    double square = 0.0;
    for (std::uint32_t i = 0; i < group.width; ++i) {
        const std::uint32_t row = group.row + i;
        const double residual = values_[row] + motion_of(packed_[row]) + alpha_[row] * lambda_[row];
        wanted[i] = lambda_[row] - residual * packed_[row].inverse_diagonal;
        square += wanted[i] * wanted[i];
    }
    const BoundedRows& bound = group.bound;
    const double limit = bound.coefficient > 0.0
                             ? bound.coefficient * std::max(lambda_[bound.normal], 0.0)
                             : bound.limit;
    const double scale = square > limit * limit ? limit / std::sqrt(square) : 1.0;
    double changed = 0.0;
    for (std::uint32_t i = 0; i < group.width; ++i) {
        const std::uint32_t row = group.row + i;
        const double change = scale * wanted[i] - lambda_[row];
        if (change != 0.0) {
            lambda_[row] += change;
            push(packed_[row], change);
            changed = std::max(changed, std::abs(change) * diagonal_[row]);
        }
    }
    return changed;
}

double RowSweeps::sweep(bool forwards, bool only_stiff) {
    double changed = 0.0;
    for (std::size_t i = 0; i < groups_.size(); ++i) {
        const Group& group = groups_[forwards ? i : groups_.size() - 1 - i];
        if (group.is_stiff || !only_stiff) {
            changed = std::max(changed, visit(group));
        }
    }
    work_ += only_stiff ? stiff_work_ : sweep_work_;
    return changed;
}

// Non-smooth nonlinear conjugate gradients: a sweep counts as a gradient step. A share of the last
// direction is added to it; if that violates a bound, the next sweep projects it back.
//   g = lambda before the sweep - after,  beta = |g|^2 / |last g|^2
//   lambda += beta p,  p <- beta p - g
// If the gradient grew, beta is 0, which restarts the search.
void RowSweeps::accelerate(double& last_square) {
    double square = 0.0;
    for (std::size_t i = 0; i < lambda_.size(); ++i) {
        const double step = lambda_[i] - last_lambda_[i];
        square += step * step * diagonal_[i];
    }
    const double beta = square < last_square ? square / last_square : 0.0;
    last_square = square;
    for (std::size_t i = 0; i < lambda_.size(); ++i) {
        const double step = lambda_[i] - last_lambda_[i];
        lambda_[i] += beta * direction_[i];
        direction_[i] = beta * direction_[i] + step;
        last_lambda_[i] = lambda_[i];
    }
    for (std::size_t slot = 0; slot < moves_.size(); ++slot) {
        for (std::size_t c = 0; c < 6; ++c) {
            const double step = moves_[slot][c] - last_moves_[slot][c];
            moves_[slot][c] += beta * direction_moves_[slot][c];
            direction_moves_[slot][c] = beta * direction_moves_[slot][c] + step;
        }
        last_moves_[slot] = moves_[slot];
    }
}

void RowSweeps::sweep_until(double tolerance, bool only_stiff, const SweepLimits& limits) {
    last_lambda_ = lambda_;
    last_moves_ = moves_;
    direction_.assign(lambda_.size(), 0.0);
    direction_moves_.assign(moves_.size(), Twist{});
    double last_square = 0.0;
    for (int i = 0; i < limits.max_sweeps && work_ < limits.max_work; ++i) {
        if (i > 0 && !only_stiff) {
            accelerate(last_square);
        }
        const double changed = sweep(i % 2 == 0, only_stiff);
        if (!is_condensed_) {
            satisfy_exact_rows();
        }
        if (changed < tolerance) {
            return;
        }
    }
}

// Recomputes the moves from the swept rows' multipliers, and the exact rows' multipliers from both.
void RowSweeps::satisfy_exact_rows() {
    std::ranges::fill(moves_, Twist{});
    for (const Group& group : groups_) {
        for (std::uint32_t i = group.row; i < group.row + group.width; ++i) {
            add_scaled(packed_[i].response_a, lambda_[i], moves_[packed_[i].slot_a]);
            add_scaled(packed_[i].response_b, lambda_[i], moves_[packed_[i].slot_b]);
        }
    }
    if (exact_rows_.empty()) {
        return;
    }
    for (std::size_t i = 0; i < exact_rows_.size(); ++i) {
        const std::uint32_t row = exact_indices_[i];
        exact_values_[i] = values_[row] + motion_of(packed_[row]);
    }
    exact_.solve(exact_values_, exact_lambda_);
    for (std::size_t i = 0; i < exact_rows_.size(); ++i) {
        const std::uint32_t row = exact_indices_[i];
        lambda_[row] = exact_lambda_[i];
        add_scaled(packed_[row].response_a, lambda_[row], moves_[packed_[row].slot_a]);
        add_scaled(packed_[row].response_b, lambda_[row], moves_[packed_[row].slot_b]);
    }
}

std::span<const double> RowSweeps::solve(std::span<const double> values,
                                         const SweepLimits& limits) {
    values_.assign(values.begin(), values.end());
    std::ranges::fill(lambda_, 0.0);
    satisfy_exact_rows();
    sweep_until(limits.heap_tolerance, false, limits);
    if (stiff_work_ > 0) {
        sweep_until(limits.tolerance, true, limits);
    }
    satisfy_exact_rows();
    return lambda_;
}

}  // namespace handhold

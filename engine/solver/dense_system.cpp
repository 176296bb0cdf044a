// Sources: LDL^T as in Golub and Van Loan, Matrix Computations, 4.1; active set: block principal
// pivoting of Judice and Pires (1994), whose steps of one row, after Murty (1974), end it where
// changing all wrong rows at once goes round in a circle.
#include "engine/solver/dense_system.hpp"

#include <algorithm>

namespace handhold {
namespace {

constexpr int k_active_set_changes = 40;  // three or four do nearly always
constexpr int k_block_changes = 3;  // of all wrong rows at once that may fail to make them fewer
// Smaller pivots belong to rows that repeat others beyond what alpha tells apart: they get no
// share.
constexpr double k_smallest_pivot = 1e-14;

// W J^T of one row: how far each unit of lambda moves the two bodies.
struct Response {
    Vec3 linear_a, angular_a, linear_b, angular_b;
};

Response response_of(const Row& row, std::span<const SolverBody> bodies,
                     std::span<const Mat3> inverse_inertia_ws) {
    const SolverBody& a = bodies[row.a];
    const SolverBody& b = bodies[row.b];
    Response out{a.inverse_mass * row.linear_a, Vec3::Zero(), -b.inverse_mass * row.linear_a,
                 Vec3::Zero()};
    if (a.inverse_mass > 0.0) {
        out.angular_a = inverse_inertia_ws[a.slot] * row.angular_a;
    }
    if (b.inverse_mass > 0.0) {
        out.angular_b = inverse_inertia_ws[b.slot] * row.angular_b;
    }
    return out;
}

double coupling(const Response& response, const Row& from, const Row& to) {
    double sum = 0.0;
    if (from.a == to.a) {
        sum += response.linear_a.dot(to.linear_a) + response.angular_a.dot(to.angular_a);
    } else if (from.a == to.b) {
        sum += response.angular_a.dot(to.angular_b) - response.linear_a.dot(to.linear_a);
    }
    if (from.b == to.b) {
        sum += response.angular_b.dot(to.angular_b) - response.linear_b.dot(to.linear_a);
    } else if (from.b == to.a) {
        sum += response.linear_b.dot(to.linear_a) + response.angular_b.dot(to.angular_a);
    }
    return sum;
}

}  // namespace

void DenseSystem::assemble(std::span<const SolverBody> bodies,
                           std::span<const Mat3> inverse_inertia_ws, std::span<const Row> rows) {
    size_ = rows.size();
    matrix_.resize(size_ * size_);
    alpha_.assign(size_, 0.0);
    lambda_.assign(size_, 0.0);
    values_.resize(size_);
    active_.assign(size_, 1);
    held_.assign(size_, 0);
    held_lambda_.assign(size_, 0.0);
    for (std::size_t i = 0; i < size_; ++i) {
        const Response response = response_of(rows[i], bodies, inverse_inertia_ws);
        for (std::size_t j = 0; j <= i; ++j) {
            const double value = coupling(response, rows[i], rows[j]);
            matrix_[i * size_ + j] = value;
            matrix_[j * size_ + i] = value;
        }
    }
}

void DenseSystem::factorise() {
    active_rows_.clear();
    for (std::uint32_t i = 0; i < size_; ++i) {
        if (active_[i] != 0 && held_[i] == 0 && matrix_[i * size_ + i] > 0.0) {
            active_rows_.push_back(i);
        }
    }
    const std::size_t count = active_rows_.size();
    factor_.resize(count * count);
    first_.resize(count);
    undivided_.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t row = active_rows_[i];
        const double* const entries = &matrix_[row * size_];
        double* const line = &factor_[i * count];
        std::uint32_t first = 0;
        while (first < i && entries[active_rows_[first]] == 0.0) {
            ++first;
        }
        first_[i] = first;
        double pivot = entries[row] + alpha_[row];
        for (std::size_t j = first; j < i; ++j) {
            double sum = entries[active_rows_[j]];
            const double* const other = &factor_[j * count];
            for (std::size_t k = std::max(first, first_[j]); k < j; ++k) {
                sum -= undivided_[k] * other[k];
            }
            undivided_[j] = sum;
        }
        for (std::size_t j = first; j < i; ++j) {
            const double other_pivot = factor_[j * count + j];
            line[j] = other_pivot > 0.0 ? undivided_[j] / other_pivot : 0.0;
            pivot -= undivided_[j] * line[j];
        }
        line[i] = pivot > k_smallest_pivot * entries[row] ? pivot : 0.0;
    }
}

void DenseSystem::substitute(std::span<const double> values) {
    const std::size_t count = active_rows_.size();
    work_.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        double sum = -values[active_rows_[i]];
        for (std::size_t k = first_[i]; k < i; ++k) {
            sum -= factor_[i * count + k] * work_[k];
        }
        work_[i] = sum;
    }
    for (std::size_t i = 0; i < count; ++i) {
        const double pivot = factor_[i * count + i];
        work_[i] = pivot > 0.0 ? work_[i] / pivot : 0.0;
    }
    for (std::size_t k = count; k-- > 0;) {
        for (std::size_t i = first_[k]; i < k; ++i) {
            work_[i] -= factor_[k * count + i] * work_[k];
        }
    }
    std::fill(lambda_.begin(), lambda_.end(), 0.0);
    for (std::size_t i = 0; i < count; ++i) {
        lambda_[active_rows_[i]] = work_[i];
    }
}

void DenseSystem::hold(std::size_t row, double lambda) {
    held_[row] = 1;
    held_lambda_[row] = lambda;
}

void DenseSystem::release(std::size_t row) {
    held_[row] = 0;
    held_lambda_[row] = 0.0;
}

double DenseSystem::remainder(std::size_t row, double value) const {
    for (std::size_t j = 0; j < size_; ++j) {
        value += matrix_[row * size_ + j] * lambda_[j];
    }
    return value;
}

// A unilateral row is wrong where it acts and pulls, or is left out and the solution would overlap
// it.
bool DenseSystem::is_wrong(const Row& row, std::size_t index) const {
    constexpr double k_overlap = 1e-10;
    if (!row.unilateral || held_[index] != 0) {
        return false;
    }
    if (active_[index] != 0) {
        return lambda_[index] < 0.0;
    }
    return remainder(index, row.value_m) < -k_overlap;
}

// What the held rows do to the others, and their own multipliers.
void DenseSystem::apply_held() {
    for (std::size_t j = 0; j < size_; ++j) {
        if (held_[j] == 0 || held_lambda_[j] == 0.0) {
            continue;
        }
        for (std::size_t i = 0; i < size_; ++i) {
            values_[i] += matrix_[i * size_ + j] * held_lambda_[j];
        }
    }
}

std::span<const double> DenseSystem::solve(std::span<const Row> rows) {
    for (std::size_t i = 0; i < size_; ++i) {
        values_[i] = rows[i].value_m;
    }
    apply_held();
    for (std::size_t i = 0; i < size_; ++i) {
        active_[i] = !rows[i].unilateral || values_[i] < 0.0 ? 1 : 0;
    }
    const auto solve_active = [this] {
        factorise();
        substitute(values_);
        for (std::size_t i = 0; i < size_; ++i) {
            lambda_[i] = held_[i] != 0 ? held_lambda_[i] : lambda_[i];
        }
    };
    std::size_t fewest = size_ + 1;
    int blocks_left = k_block_changes;
    for (int change = 0; change < k_active_set_changes; ++change) {
        solve_active();
        wrong_rows_.clear();
        for (std::uint32_t i = 0; i < size_; ++i) {
            if (is_wrong(rows[i], i)) {
                wrong_rows_.push_back(i);
            }
        }
        if (wrong_rows_.empty()) {
            return lambda_;
        }
        if (wrong_rows_.size() < fewest) {
            fewest = wrong_rows_.size();
            blocks_left = k_block_changes;
        } else if (blocks_left > 0) {
            --blocks_left;
        } else {
            wrong_rows_.assign(1, wrong_rows_.back());
        }
        for (const std::uint32_t i : wrong_rows_) {
            active_[i] ^= 1U;
        }
    }
    // No agreement: take the last set without its pulling rows.
    solve_active();
    for (std::size_t i = 0; i < size_; ++i) {
        if (rows[i].unilateral && lambda_[i] < 0.0) {
            lambda_[i] = 0.0;
        }
    }
    return lambda_;
}

std::span<const double> DenseSystem::solve_again(std::span<const double> values) {
    substitute(values);
    return lambda_;
}

}  // namespace handhold

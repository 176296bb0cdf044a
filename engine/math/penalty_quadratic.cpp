#include "engine/math/penalty_quadratic.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "engine/core/check.hpp"
#include "engine/math/double4.hpp"
#include "engine/math/processor.hpp"

namespace handhold {
namespace {

constexpr int k_max_newton_steps = 24;
constexpr int k_max_line_steps = 16;
constexpr double k_converged = 1e-10;  // relative length of the last step

// Unknowns are processed four at a time.
constexpr std::size_t k_blocks = k_max_unknowns / 4;
static_assert(k_max_unknowns % 4 == 0);

// Aligned copies of Unknowns and UnknownsSquare.
struct Vector {
    alignas(32) double at[k_max_unknowns];
};
struct Square {
    Vector row[k_max_unknowns];
};

HH_INLINE Double4 load4(const double* from) {
    Double4 value;
    std::memcpy(&value, from, sizeof(value));
    return value;
}
HH_INLINE void store4(const Double4& value, double* to) { std::memcpy(to, &value, sizeof(value)); }

// The sum over the blocks from `first` on.
HH_INLINE double dot_from(std::size_t first, const double* a, const double* b) {
    Double4 sum = zero4();
    for (std::size_t block = first; block < k_blocks; ++block) {
        sum += load4(a + 4 * block) * load4(b + 4 * block);
    }
    return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}
// to += factor * from, in the blocks from `first` on.
HH_INLINE void add_from(std::size_t first, double factor, const double* from, double* to) {
    for (std::size_t block = first; block < k_blocks; ++block) {
        store4(load4(to + 4 * block) + factor * load4(from + 4 * block), to + 4 * block);
    }
}

// Writes row i of U, whose entries left of the diagonal are undefined. First = i / 4.
template <std::size_t First>
HH_INLINE void eliminate_row(std::size_t i, Square& matrix, Vector& inverse_pivots) {
    constexpr double k_min_pivot = 1e-30;
    constexpr std::size_t k_count = k_blocks - First;
    double* const row = matrix.row[i].at;
    Double4 sum[k_count];
    for (std::size_t b = 0; b < k_count; ++b) {
        sum[b] = load4(row + 4 * (First + b));
    }
    for (std::size_t above = 0; above < i; ++above) {
        const double* const from = matrix.row[above].at;
        for (std::size_t b = 0; b < k_count; ++b) {
            sum[b] -= from[i] * load4(from + 4 * (First + b));
        }
    }
    const double inverse = 1.0 / std::sqrt(std::max(sum[0][i - 4 * First], k_min_pivot));
    for (std::size_t b = 0; b < k_count; ++b) {
        store4(inverse * sum[b], row + 4 * (First + b));
    }
    inverse_pivots.at[i] = inverse;
}

template <std::size_t First>
HH_INLINE void eliminate_rows(std::size_t count, Square& matrix, Vector& inverse_pivots) {
    for (std::size_t i = 4 * First; i < std::min(count, 4 * First + 4); ++i) {
        eliminate_row<First>(i, matrix, inverse_pivots);
    }
    if constexpr (First + 1 < k_blocks) {
        if (4 * (First + 1) < count) {
            eliminate_rows<First + 1>(count, matrix, inverse_pivots);
        }
    }
}

// Replaces the upper triangle of `matrix` by its Cholesky factor U and `vector` by the solution of
// U^T U x = vector. Entries of `vector` from `count` on become 0.
HH_INLINE void solve_positive_definite(std::size_t count, Square& matrix, Vector& vector) {
    Vector inverse_pivots;  // NOLINT(*-member-init): filled as far as used
    eliminate_rows<0>(count, matrix, inverse_pivots);
    Vector between;  // NOLINT(*-member-init): U x, filled as far as used
    for (std::size_t i = 0; i < count; ++i) {
        between.at[i] = vector.at[i] * inverse_pivots.at[i];
        add_from(i / 4, -between.at[i], matrix.row[i].at, vector.at);
    }
    std::fill(std::begin(vector.at), std::end(vector.at), 0.0);
    for (std::size_t i = count; i-- > 0;) {
        vector.at[i] =
            (between.at[i] - dot_from(i / 4, matrix.row[i].at, vector.at)) * inverse_pivots.at[i];
    }
}

// Value of an inequality along a step: value + length * along.
struct RowOnLine {
    double value;
    double along;
    double weight;
};

// Returns the step length in [0, 1] that minimises the function along the step. Its slope is
//   slope_at_zero + length * curvature + the contributions of the violated rows.
// The slope rises with the length, and is linear between the lengths at which a row changes between
// violated and satisfied. Newton's method, kept between bounds, finds its zero.
double best_length(double slope_at_zero, double curvature, std::span<const RowOnLine> rows) {
    constexpr double k_same = 1e-9;
    double low = 0.0;
    double high = 1.0;
    double length = 1.0;
    for (int i = 0; i < k_max_line_steps; ++i) {
        double slope = slope_at_zero + length * curvature;
        double change = curvature;
        for (const RowOnLine& row : rows) {
            const double value = row.value + length * row.along;
            if (value < 0.0) {
                slope += row.weight * value * row.along;
                change += row.weight * row.along * row.along;
            }
        }
        if (length == 1.0 && slope <= 0.0) {
            return 1.0;
        }
        (slope > 0.0 ? high : low) = length;
        if (!(change > 0.0)) {
            break;
        }
        const double next = length - slope / change;
        const double kept = next > low && next < high ? next : 0.5 * (low + high);
        if (std::abs(kept - length) < k_same) {
            return kept;
        }
        length = kept;
    }
    return length;
}

// Adds a violated row to the Newton system matrix * step = -gradient.
HH_INLINE void add_violated(const PenaltyRow& row, double value, std::size_t count, Square& matrix,
                            Vector& step) {
    const double* const slope = row.slope.data();
    if (row.only >= 0) {
        step.at[row.only] -= row.weight * value * slope[row.only];
        matrix.row[row.only].at[row.only] += row.weight * slope[row.only] * slope[row.only];
        return;
    }
    add_from(0, -row.weight * value, slope, step.at);
    for (std::size_t k = 0; k < count; ++k) {
        if (slope[k] != 0.0) {
            add_from(k / 4, row.weight * slope[k], slope, matrix.row[k].at);
        }
    }
}

HH_INLINE void minimise(const UnknownsSquare& hessian, const Unknowns& gradient,
                        std::span<const PenaltyRow> rows, std::size_t count, Unknowns& result) {
    double values[k_max_penalty_rows];   // NOLINT(*-member-init): filled as far as used
    double along[k_max_penalty_rows];    // NOLINT(*-member-init)
    RowOnLine line[k_max_penalty_rows];  // NOLINT(*-member-init)
    for (std::size_t r = 0; r < rows.size(); ++r) {
        values[r] = rows[r].value;
    }
    Vector x = {};
    Vector turned = {};  // hessian * x
    Square matrix;       // NOLINT(*-member-init): only its upper triangle is used
    for (int newton = 0; newton < k_max_newton_steps; ++newton) {
        for (std::size_t i = 0; i < count; ++i) {
            std::memcpy(matrix.row[i].at, hessian.data() + i * k_max_unknowns, sizeof(Vector));
        }
        Vector step;  // NOLINT(*-member-init)
        for (std::size_t block = 0; block < k_blocks; ++block) {
            store4(-load4(gradient.data() + 4 * block) - load4(turned.at + 4 * block),
                   step.at + 4 * block);
        }
        for (std::size_t r = 0; r < rows.size(); ++r) {
            if (values[r] < 0.0) {
                add_violated(rows[r], values[r], count, matrix, step);
            }
        }
        solve_positive_definite(count, matrix, step);
        std::size_t line_count = 0;  // rows that are violated somewhere along the step
        for (std::size_t r = 0; r < rows.size(); ++r) {
            const int i = rows[r].only;
            along[r] = i >= 0 ? rows[r].slope.data()[i] * step.at[i]
                              : dot_from(0, rows[r].slope.data(), step.at);
            if (std::min(values[r], values[r] + along[r]) < 0.0) {
                line[line_count++] = {values[r], along[r], rows[r].weight};
            }
        }
        Vector bent = {};  // hessian * step
        for (std::size_t i = 0; i < count; ++i) {
            add_from(0, step.at[i], hessian.data() + i * k_max_unknowns, bent.at);
        }
        const double length =
            best_length(dot_from(0, turned.at, step.at) + dot_from(0, gradient.data(), step.at),
                        dot_from(0, bent.at, step.at), {line, line_count});
        add_from(0, length, step.at, x.at);
        add_from(0, length, bent.at, turned.at);
        // If the whole step is taken and the same rows stay violated, it ends exactly at the
        // minimum.
        bool is_exact = length == 1.0;
        for (std::size_t r = 0; r < rows.size(); ++r) {
            const double before = values[r];
            values[r] += length * along[r];
            is_exact = is_exact && (before < 0.0) == (values[r] < 0.0);
        }
        const double travel = length * std::sqrt(dot_from(0, step.at, step.at));
        if (is_exact || travel <= k_converged * (1.0 + std::sqrt(dot_from(0, x.at, x.at)))) {
            break;
        }
    }
    std::memcpy(result.data(), x.at, sizeof(x));
}

#ifdef HH_AVX2
HH_AVX2 void minimise_avx2(const UnknownsSquare& hessian, const Unknowns& gradient,
                           std::span<const PenaltyRow> rows, std::size_t count, Unknowns& result) {
    minimise(hessian, gradient, rows, count, result);
}
#endif
void minimise_portable(const UnknownsSquare& hessian, const Unknowns& gradient,
                       std::span<const PenaltyRow> rows, std::size_t count, Unknowns& result) {
    minimise(hessian, gradient, rows, count, result);
}

}  // namespace

Unknowns minimise_penalised(const UnknownsSquare& hessian, const Unknowns& gradient,
                            std::span<const PenaltyRow> rows, std::size_t count, Vectors vectors) {
    HH_CHECK(count <= k_max_unknowns && rows.size() <= k_max_penalty_rows, "a small problem",
             count);
    Unknowns x;
#ifdef HH_AVX2
    if (vectors == Vectors::avx2) {
        minimise_avx2(hessian, gradient, rows, count, x);
        return x;
    }
#endif
    (void)vectors;
    minimise_portable(hessian, gradient, rows, count, x);
    return x;
}

}  // namespace handhold

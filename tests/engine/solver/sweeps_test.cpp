// Sweeps against the direct active set, and what holds however few sweeps are made.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "engine/solver/newton/active_set.hpp"
#include "engine/solver/sweeps/row_sweeps.hpp"
#include "tests/engine/solver/scene.hpp"

namespace handhold::solver_sweeps_test {
namespace {

using test::Random;

// Random bodies that joints and contacts connect. Row i's residual is random.
struct Problem {
    std::vector<SolverBody> bodies;
    std::vector<Mat3> inverse_inertias_ws;
    std::vector<Row> rows;

    explicit Problem(Random& random) {
        bodies = {test::fixed_body(1)};
        const auto count = 2 + static_cast<std::uint32_t>(random.engine()() % 4);
        for (std::uint32_t i = 1; i <= count; ++i) {
            bodies.push_back(test::random_free_body(i + 1, random));
        }
        for (std::uint32_t i = 0; i < bodies.size(); ++i) {
            bodies[i].slot = i;
            inverse_inertias_ws.push_back(inverse_inertia_ws(bodies[i]));
        }
        for (std::uint32_t i = 1; i <= count; ++i) {
            const auto other = static_cast<std::uint32_t>(random.engine()() % i);
            const bool is_joint = random.between(0.0, 1.0) < 0.5;
            RowBlock block =
                test::random_block(is_joint ? RowKind::ball : RowKind::contact, i, other, random);
            append_rows(bodies, block, i, rows);
        }
        for (Row& row : rows) {
            row.residual = random.between(-0.1, 0.1);
        }
    }
    std::vector<double> residuals() const {
        std::vector<double> values;
        for (const Row& row : rows) {
            values.push_back(row.residual);
        }
        return values;
    }
};

RowSweeps factorised(const Problem& problem, double alpha) {
    RowSweeps sweeps;
    sweeps.assemble(problem.bodies, problem.inverse_inertias_ws, problem.rows, {});
    std::ranges::fill(sweeps.alpha(), alpha);
    sweeps.factorise();
    return sweeps;
}

RC_GTEST_PROP(RowSweeps, ConvergeToTheDirectSolution, (std::uint64_t seed)) {
    constexpr double k_alpha = 1e-6;
    Random random(seed);
    const Problem problem(random);
    RowSystem direct;
    direct.assemble(problem.bodies, problem.inverse_inertias_ws, problem.rows);
    std::ranges::fill(direct.alpha(), k_alpha);
    const std::span<const double> expected = direct.solve(problem.rows);
    RowSweeps sweeps = factorised(problem, k_alpha);
    const std::span<const double> lambda =
        sweeps.solve(problem.residuals(), {1'000'000, 5000, 1e-13, 1e-13});
    for (std::size_t i = 0; i < problem.rows.size(); ++i) {
        RC_ASSERT(std::abs(lambda[i] - expected[i]) <= 1e-5 * (1.0 + std::abs(expected[i])));
    }
    for (std::size_t slot = 0; slot < sweeps.moves().size(); ++slot) {
        for (std::size_t c = 0; c < 6; ++c) {
            RC_ASSERT(std::abs(sweeps.moves()[slot][c] - direct.moves()[slot][c]) <= 1e-6);
        }
    }
}

RC_GTEST_PROP(RowSweeps, JointsHoldAndContactsPushAfterAnyNumberOfSweeps, (std::uint64_t seed)) {
    constexpr double k_alpha = 1e-9;
    Random random(seed);
    const Problem problem(random);
    RowSweeps sweeps = factorised(problem, k_alpha);
    const int count = static_cast<int>(random.engine()() % 4);
    const std::span<const double> lambda =
        sweeps.solve(problem.residuals(), {1'000'000, count, 0.0, 0.0});
    for (std::size_t i = 0; i < problem.rows.size(); ++i) {
        const Row& row = problem.rows[i];
        if (row.unilateral) {
            RC_ASSERT(lambda[i] >= 0.0);
        } else {
            const double rest = sweeps.remaining_residual(i, row.residual) + k_alpha * lambda[i];
            RC_ASSERT(std::abs(rest) <= 1e-9);
        }
    }
}

RC_GTEST_PROP(RowSweeps, WorkEndsTheSweeps, (std::uint64_t seed)) {
    Random random(seed);
    const Problem problem(random);
    RowSweeps sweeps = factorised(problem, 1e-6);
    const std::uint64_t before = sweeps.work();
    sweeps.solve(problem.residuals(), {before, 1000, 0.0, 0.0});
    RC_ASSERT(sweeps.work() == before);
}

}  // namespace
}  // namespace handhold::solver_sweeps_test

// RowSystem solves bilateral and redundant rows as the dense matrix does.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "dense_rows.hpp"

namespace handhold::solver_system_test {
namespace {

using namespace test::dense_rows;
using test::Random;

RC_GTEST_PROP(RowSystem, BilateralRowsAgreeWithEigen, (std::uint64_t seed)) {
    constexpr double k_alpha = 1e-4;
    Random random(seed);
    const Problem problem = random_problem(5, 4, 0, random);
    RowSystem system = assembled(problem, k_alpha);
    const VectorXd lambda = as_vector(system.solve(problem.rows));
    const VectorXd expected = regularised(problem, k_alpha).ldlt().solve(-problem.values());
    RC_ASSERT((lambda - expected).norm() < 1e-9 * expected.norm());
}

// A tree over all bodies with a few loops, in which the first free body has a third of all blocks
// and the fixed body another third.
Problem random_net(std::uint32_t body_count, Random& random) {
    Problem problem;
    problem.place_bodies(random_bodies(body_count, random));
    const auto add = [&](std::uint32_t a, std::uint32_t b) {
        const RowKind kinds[] = {RowKind::ball, RowKind::hinge, RowKind::fixed, RowKind::contact};
        const RowKind kind = kinds[random_index(4, random)];
        problem.add_block(test::random_block(kind, std::min(a, b), std::max(a, b), random));
    };
    for (std::uint32_t i = 1; i < body_count; ++i) {
        const std::uint32_t choice = random_index(3, random);
        add(i, choice == 0 ? 0 : random_index(i, random));
        if (choice == 1 && i != 1) {
            add(i, 1);
        } else if (choice == 2 && i + 1 != body_count) {
            add(i, body_count - 1);
        }
    }
    std::ranges::stable_sort(problem.rows, {},
                             [](const Row& row) { return std::tie(row.a, row.b); });
    return problem;
}

// Translating bodies do not rotate and fixed bodies do not move; the first bodies include hubs of
// both.
RC_GTEST_PROP(RowSystem, NetworksWithHubsAgreeWithEigen, (std::uint64_t seed)) {
    constexpr double k_alpha = 1e-4;
    Random random(seed);
    Problem problem = random_net(5 + random_index(26, random), random);
    for (Row& row : problem.rows) {
        row.unilateral = false;
    }
    RowSystem system = assembled(problem, k_alpha);
    const VectorXd lambda = as_vector(system.solve(problem.rows));
    const VectorXd expected = regularised(problem, k_alpha).ldlt().solve(-problem.values());
    RC_ASSERT((lambda - expected).norm() < 1e-8 * expected.norm());
}

// Structures solved before must not affect the result.
TEST(RowSystem, CachedPlansChangeNoBit) {
    Random random(7);
    std::vector<Problem> problems;
    for (std::uint32_t count = 3; count < 20; ++count) {
        problems.push_back(random_net(count, random));
    }
    RowSystem reused;
    for (int round = 0; round < 2; ++round) {
        for (const Problem& problem : problems) {
            reused.assemble(problem.bodies, problem.inverse_inertias_ws, problem.rows);
            std::ranges::fill(reused.alpha(), 1e-6);
            RowSystem fresh = assembled(problem, 0.0);
            std::ranges::fill(fresh.alpha(), 1e-6);
            EXPECT_TRUE(std::ranges::equal(reused.solve(problem.rows), fresh.solve(problem.rows)));
        }
    }
}

// The last factor is used again only if alpha and the chosen rows are the same.
TEST(RowSystem, ChangedAlphaIsFactorisedAgain) {
    Random random(8);
    const Problem problem = random_problem(5, 4, 0, random);
    RowSystem reused = assembled(problem, 1e-6);
    reused.solve(problem.rows);
    for (const double alpha : {0.1, 1e-6}) {
        for (std::size_t i = 0; i < reused.size(); ++i) {
            reused.alpha()[i] = alpha * reused.diagonal(i);
        }
        RowSystem fresh = assembled(problem, alpha);
        EXPECT_TRUE(std::ranges::equal(reused.solve(problem.rows), fresh.solve(problem.rows)));
    }
}

TEST(RowMatrix, ChangedRowsAreFactorisedAgain) {
    Random random(9);
    const Problem problem = random_problem(5, 4, 0, random);
    const auto assemble = [&](RowMatrix& matrix) {
        matrix.assemble(problem.bodies, problem.inverse_inertias_ws, problem.rows);
        std::ranges::fill(matrix.alpha(), 1e-6);
    };
    const VectorXd values = problem.values();
    const auto solve = [&](RowMatrix& matrix, const std::vector<std::uint8_t>& chosen) {
        std::vector<double> lambda(problem.rows.size());
        matrix.factorise(chosen);
        matrix.solve({values.data(), problem.rows.size()}, lambda);
        return lambda;
    };
    const std::vector<std::uint8_t> all(problem.rows.size(), 1);
    std::vector<std::uint8_t> fewer = all;
    fewer[1] = 0;
    RowMatrix reused;
    assemble(reused);
    for (const auto& chosen : {all, all, fewer, all}) {
        RowMatrix fresh;
        assemble(fresh);
        EXPECT_EQ(solve(reused, chosen), solve(fresh, chosen));
    }
    EXPECT_NE(solve(reused, fewer), solve(reused, all));
}

RC_GTEST_PROP(RowSystem, DiagonalEqualsThatOfTheDenseMatrix, (std::uint64_t seed)) {
    Random random(seed);
    const Problem problem = random_problem(5, 3, 3, random);
    const RowSystem system = assembled(problem, 0.0);
    const MatrixXd matrix = problem.matrix();
    for (std::size_t i = 0; i < system.size(); ++i) {
        const auto at = static_cast<Eigen::Index>(i);
        RC_ASSERT(std::abs(system.diagonal(i) - matrix(at, at)) < 1e-12 * (1.0 + matrix(at, at)));
    }
}

// A ball of 2 kg, overlapping a plane by 1 cm, with `copies` equal contacts.
Problem overlapping_ball(int copies) {
    Problem problem;
    problem.place_bodies(
        {test::ball(1, 2.0, 0.1, {Vec3(0.0, 0.09, 0.0), Quat::Identity()}), test::fixed_body(2)});
    for (int i = 0; i < copies; ++i) {
        problem.add_block(test::row_block(RowKind::contact, 0, 1, Vec3(0.0, -0.1, 0.0)));
    }
    return problem;
}

TEST(RowSystem, RepeatedRowsWithoutAlphaActAsOne) {
    const Problem problem = overlapping_ball(3);
    RowSystem system = assembled(problem, 0.0);
    const VectorXd lambda = as_vector(system.solve(problem.rows));
    EXPECT_NEAR(lambda.sum(), 2.0 * 0.01, 1e-15);  // mass times overlap
    EXPECT_TRUE(lambda.allFinite());
}

TEST(RowSystem, RepeatedRowsWithAlphaShareEvenly) {
    constexpr double k_alpha = 1e-7;
    const Problem problem = overlapping_ball(3);
    RowSystem system = assembled(problem, k_alpha);
    const VectorXd lambda = as_vector(system.solve(problem.rows));
    for (Eigen::Index i = 0; i < 3; ++i) {
        // (3 + alpha) / m lambda = overlap; the pivots lose 16 - 7 digits.
        EXPECT_NEAR(lambda[i], 2.0 * 0.01 / (3.0 + k_alpha), 1e-10);
    }
}

TEST(RowSystem, ImmovableRowsGetZeroMultipliers) {
    Problem problem;
    problem.place_bodies({test::fixed_body(1), test::fixed_body(2), test::ball(3, 2.0, 0.1)});
    problem.add_block(test::row_block(RowKind::contact, 0, 1, Vec3(0.0, -0.1, 0.0)));
    problem.add_block(test::row_block(RowKind::drive_weld, 0, 1, Vec3(0.0, -0.1, 0.0)));
    problem.add_block(test::row_block(RowKind::drive_point, 0, 2, Vec3(0.5, 0.0, 0.0)));
    RowSystem system = assembled(problem, 1e-6);
    const VectorXd lambda = as_vector(system.solve(problem.rows));
    ASSERT_EQ(lambda.size(), 10);
    for (Eigen::Index i = 0; i < 7; ++i) {
        EXPECT_EQ(lambda[i], 0.0) << "row " << i;
    }
    EXPECT_NEAR(lambda[7], -2.0 * 0.5, 1e-5);
}

TEST(RowSystem, EmptySystemHasAnEmptySolution) {
    Problem problem;
    problem.place_bodies({test::ball(1, 2.0, 0.1)});
    RowSystem system = assembled(problem, 1e-7);
    EXPECT_EQ(system.size(), 0U);
    EXPECT_TRUE(system.solve(problem.rows).empty());
}

}  // namespace
}  // namespace handhold::solver_system_test

// Unilateral rows: RowSystem's active set satisfies the Karush-Kuhn-Tucker conditions.
#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "dense_rows.hpp"

namespace handhold::solver_active_set_test {
namespace {

using namespace test::dense_rows;
using test::Random;

// Oracle: tries all subsets of active unilateral rows for the one whose solution satisfies the
// Karush-Kuhn-Tucker conditions: each active row pushes, no other row overlaps. For a positive
// definite matrix there is exactly one, except for ties.
struct Optimum {
    VectorXd lambda;
    double margin = 0.0;  // distance to violating a condition; tiny: a tie
};
std::optional<Optimum> brute_force(const MatrixXd& matrix, const Problem& problem) {
    const VectorXd values = problem.values();
    std::vector<Eigen::Index> unilateral;
    for (std::size_t i = 0; i < problem.rows.size(); ++i) {
        if (problem.rows[i].unilateral) {
            unilateral.push_back(static_cast<Eigen::Index>(i));
        }
    }
    for (unsigned set = 0; set < (1U << unilateral.size()); ++set) {
        MatrixXd reduced = matrix;
        VectorXd right = -values;
        for (std::size_t i = 0; i < unilateral.size(); ++i) {
            if ((set >> i & 1U) == 0) {
                reduced.row(unilateral[i]).setZero();
                reduced.col(unilateral[i]).setZero();
                reduced(unilateral[i], unilateral[i]) = 1.0;
                right[unilateral[i]] = 0.0;
            }
        }
        const VectorXd lambda = reduced.ldlt().solve(right);
        const VectorXd after = matrix * lambda + values;
        double margin = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < unilateral.size(); ++i) {
            const bool pushes = (set >> i & 1U) != 0;
            margin = std::min(margin, pushes ? lambda[unilateral[i]] : after[unilateral[i]]);
        }
        if (margin > 0.0) {
            return Optimum{lambda, margin};
        }
    }
    return std::nullopt;
}

// Relative difference from the oracle; none if the problem is a tie.
std::optional<double> active_set_error(std::uint64_t seed) {
    constexpr double k_alpha = 1e-3;
    Random random(seed);
    const int contacts = 1 + static_cast<int>(random_index(6, random));
    const Problem problem =
        random_problem(4, static_cast<int>(random_index(3, random)), contacts, random);
    const MatrixXd matrix = regularised(problem, k_alpha);
    const auto optimum = brute_force(matrix, problem);
    if (!optimum || optimum->margin < 1e-9) {
        return std::nullopt;
    }
    RowSystem system = assembled(problem, k_alpha);
    const VectorXd lambda = as_vector(system.solve(problem.rows));
    return (lambda - optimum->lambda).norm() / (1.0 + optimum->lambda.norm());
}

RC_GTEST_PROP(RowSystem, ActiveSetSatisfiesTheKktConditions, (std::uint64_t seed)) {
    const auto error = active_set_error(seed);
    RC_PRE(error.has_value());
    RC_ASSERT(*error < 1e-8);
}

// About one problem in 4000: block pivoting returns to its start here.
TEST(RowSystem, CyclingActiveSetIsResolvedByDescent) {
    const auto error = active_set_error(3634);
    ASSERT_TRUE(error.has_value());
    EXPECT_LT(*error, 1e-8);
}

// A body that penetrates or nears several faces, some points repeated: far more contacts than
// degrees of freedom, often without a feasible pose.
Problem crowded_contacts(Random& random) {
    Problem problem;
    problem.place_bodies({test::random_free_body(1, random), test::fixed_body(2)});
    const Vec3 outward = random.direction();
    const std::uint32_t faces = 2 + random_index(10, random);
    for (std::uint32_t face = 0; face < faces; ++face) {
        RowBlock block = test::random_block(RowKind::contact, 0, 1, random);
        const bool is_ceiling = random_index(4, random) == 0;
        block.normal_b_bs = ((is_ceiling ? -1.0 : 1.0) * outward + random.vector(0.7)).normalized();
        const double depth_m = random.between(-0.35, 0.2);
        const std::uint32_t points = 1 + random_index(5, random);
        for (std::uint32_t point = 0; point < points; ++point) {
            if (random_index(4, random) != 0) {
                block.point_a_bs = random.vector(0.3);
            }
            problem.add_block(block);
            problem.rows.back().residual = depth_m + random.between(-0.05, 0.05);
        }
    }
    return problem;
}

TEST(RowSystem, CrowdedContactsConverge) {
    int active_set_unconverged = 0;
    for (std::uint64_t seed = 0; seed < 2000; ++seed) {
        Random random(seed);
        const Problem problem = crowded_contacts(random);
        RowSystem system = assembled(problem, 1e-7);
        const std::span<const double> lambda = system.solve(problem.rows);
        active_set_unconverged += system.is_active_set_unconverged() ? 1 : 0;
        for (std::size_t i = 0; i < problem.rows.size(); ++i) {
            ASSERT_GE(lambda[i], 0.0) << seed;
            if (!system.is_active(i) && !system.is_active_set_unconverged()) {
                ASSERT_GE(system.remaining_residual(i, problem.rows[i].residual), -1e-8) << seed;
            }
        }
    }
    EXPECT_EQ(active_set_unconverged, 0);
}

// Work for some factorisations only, as at the end of an island's budget. Drives in opposite
// directions need multipliers that cancel; one that is cut off leaves the others unbalanced.
TEST(RowSystem, UnconvergedActiveSetMovesNothingFartherThanItsRowsJustify) {
    constexpr double k_alpha = 1e-7;
    int unconverged = 0;
    int moved = 0;
    for (std::uint64_t seed = 0; seed < 4000; ++seed) {
        Random random(seed);
        const int drives = static_cast<int>(random_index(4, random));
        const int contacts = 2 + static_cast<int>(random_index(12, random));
        const Problem problem = random_problem(4, drives, contacts, random);
        RowSystem system = assembled(problem, k_alpha);
        system.limit_work(1 + random_index(40, random));
        const VectorXd lambda = as_vector(system.solve(problem.rows));
        if (!system.is_active_set_unconverged()) {
            continue;
        }
        ++unconverged;
        moved += lambda.norm() > 0.0 ? 1 : 0;
        const double work = lambda.dot(problem.values());
        const double energy = 0.5 * lambda.dot(regularised(problem, k_alpha) * lambda);
        ASSERT_LE(energy + work, 1e-9 * energy) << seed;
        for (std::size_t i = 0; i < problem.rows.size(); ++i) {
            const double pull = -lambda[static_cast<Eigen::Index>(i)];
            ASSERT_TRUE(!problem.rows[i].unilateral || pull <= 0.0) << seed;
        }
    }
    EXPECT_GT(unconverged, 400);
    EXPECT_GT(moved, unconverged / 2);
}

RC_GTEST_PROP(RowSystem, LastFactorSolvesOtherResidualsWithTheSameActiveSet, (std::uint64_t seed)) {
    constexpr double k_alpha = 1e-3;
    Random random(seed);
    const Problem problem = random_problem(4, 2, 3, random);
    RowSystem system = assembled(problem, k_alpha);
    system.solve(problem.rows);
    std::vector<double> others;
    MatrixXd reduced = regularised(problem, k_alpha);
    for (std::size_t i = 0; i < problem.rows.size(); ++i) {
        others.push_back(random.between(-1.0, 1.0));
        if (!system.is_active(i)) {
            const auto at = static_cast<Eigen::Index>(i);
            reduced.row(at).setZero();
            reduced.col(at).setZero();
            reduced(at, at) = 1.0;
        }
    }
    VectorXd right = -as_vector(others);
    for (std::size_t i = 0; i < problem.rows.size(); ++i) {
        if (!system.is_active(i)) {
            right[static_cast<Eigen::Index>(i)] = 0.0;
        }
    }
    const VectorXd expected = reduced.ldlt().solve(right);
    RC_ASSERT((as_vector(system.solve_with_last_factor(others)) - expected).norm() <
              1e-9 * (1.0 + expected.norm()));
}

TEST(RowSystem, SeparatedContactBecomesActiveWhenAnotherRowPushesIntoIt) {
    Problem problem;
    problem.place_bodies(
        {test::ball(1, 2.0, 0.1, {Vec3(0.0, 0.11, 0.0), Quat::Identity()}), test::fixed_body(2)});
    problem.add_block(test::row_block(RowKind::contact, 0, 1, Vec3(0.0, -0.1, 0.0)));
    RowSystem alone = assembled(problem, 1e-7);
    EXPECT_EQ(alone.solve(problem.rows)[0], 0.0);
    EXPECT_FALSE(alone.is_active(0));

    // A ceiling that overlaps by 3 cm pushes the ball 3 cm down, through the floor 1 cm below it.
    // Both contacts become active.
    RowBlock ceiling =
        test::row_block(RowKind::contact, 0, 1, Vec3(0.0, 0.1, 0.0), Vec3(0.0, 0.18, 0.0));
    ceiling.normal_b_bs = -Vec3::UnitY();
    problem.add_block(ceiling);
    RowSystem between = assembled(problem, 1e-3);
    const std::span<const double> lambda = between.solve(problem.rows);
    EXPECT_TRUE(between.is_active(0));
    EXPECT_GT(lambda[0], 0.0);
    EXPECT_GT(lambda[1], lambda[0]);
}

}  // namespace
}  // namespace handhold::solver_active_set_test

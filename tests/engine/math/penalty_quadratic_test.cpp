#include "engine/math/penalty_quadratic.hpp"

#include <algorithm>
#include <cstring>
#include <vector>

#include <gtest/gtest.h>

#include "tests/random.hpp"

namespace handhold::penalty_quadratic_test {
namespace {

Unknowns random_slope(test::Random& random, std::size_t count) {
    Unknowns slope = Unknowns::Zero();
    for (std::size_t i = 0; i < count; ++i) {
        slope[static_cast<int>(i)] = random.between(-1.0, 1.0);
    }
    return slope;
}

struct Problem {
    std::size_t count;
    UnknownsSquare hessian = UnknownsSquare::Zero();
    Unknowns gradient;
    std::vector<PenaltyRow> rows;

    Problem(test::Random& random, std::size_t unknowns, std::size_t row_count, double stiffness)
        : count(unknowns) {
        for (std::size_t i = 0; i < 2 * count; ++i) {
            const Unknowns slope = random_slope(random, count);
            hessian += slope * slope.transpose();
        }
        gradient = random_slope(random, count);
        for (std::size_t i = 0; i < row_count; ++i) {
            const Unknowns slope = random_slope(random, count);
            rows.push_back({slope, random.between(-0.5, 0.5), stiffness});
        }
    }
    // Turns every second row into a limit of one unknown.
    void limit_single_unknowns(test::Random& random) {
        for (std::size_t r = 0; r < rows.size(); r += 2) {
            const auto place = static_cast<int>(random.between(0.0, static_cast<double>(count)));
            rows[r].slope = Unknowns::Zero();
            rows[r].slope[place] = r % 4 == 0 ? 1.0 : -0.7;
            rows[r].only = place;
        }
    }
    Unknowns gradient_at(const Unknowns& x) const {
        Unknowns sum = hessian * x + gradient;
        for (const PenaltyRow& row : rows) {
            sum += row.weight * std::min(0.0, row.value + row.slope.dot(x)) * row.slope;
        }
        return sum;
    }
};

// The function is convex: its gradient is 0 at the minimum and nowhere else.
TEST(MinimisePenalised, GradientVanishesAtTheResult) {
    test::Random random(71);
    for (int i = 0; i < 300; ++i) {
        const auto unknowns = static_cast<std::size_t>(random.between(1.0, k_max_unknowns + 0.99));
        const auto rows = static_cast<std::size_t>(random.between(0.0, 150.0));
        const double stiffness = i % 2 == 0 ? 1.0 : 2000.0;
        const Problem problem(random, unknowns, rows, stiffness);
        const Unknowns x =
            minimise_penalised(problem.hessian, problem.gradient, problem.rows, unknowns);
        EXPECT_LT(problem.gradient_at(x).norm(), 1e-6 * stiffness) << i;
        EXPECT_TRUE(x.tail(static_cast<int>(k_max_unknowns - unknowns)).isZero(0.0)) << i;
    }
}

// Two rows that contradict each other share the violation by their weights.
TEST(MinimisePenalised, ContradictingRowsShareTheViolation) {
    UnknownsSquare hessian = UnknownsSquare::Zero();
    hessian(0, 0) = 1e-9;
    Unknowns up = Unknowns::Zero();
    up[0] = 1.0;
    const std::vector<PenaltyRow> rows = {{up, -1.0, 3.0}, {-up, -1.0, 1.0}};  // x >= 1, x <= -1
    const Unknowns x = minimise_penalised(hessian, Unknowns::Zero(), rows, 1);
    EXPECT_NEAR(x[0], 0.5, 1e-6);
}

TEST(MinimisePenalised, VectorsOfTheProcessorDoNotChangeBits) {
    if (fastest_vectors() == Vectors::portable) {
        GTEST_SKIP() << "the processor's vectors are the portable ones";
    }
    test::Random random(74);
    for (int i = 0; i < 300; ++i) {
        const auto unknowns = static_cast<std::size_t>(random.between(1.0, k_max_unknowns + 0.99));
        Problem problem(random, unknowns, 100, 500.0);
        problem.limit_single_unknowns(random);
        const auto solve = [&](Vectors vectors) {
            return minimise_penalised(problem.hessian, problem.gradient, problem.rows, unknowns,
                                      vectors);
        };
        const Unknowns portable = solve(Vectors::portable);
        const Unknowns fastest = solve(fastest_vectors());
        EXPECT_EQ(std::memcmp(portable.data(), fastest.data(), sizeof(double) * k_max_unknowns), 0)
            << i;
    }
}

// Rows that limit one unknown have a shorter form inside.
TEST(MinimisePenalised, LimitsOfOneUnknownAreRowsLikeOthers) {
    test::Random random(73);
    std::size_t violated = 0;
    for (int i = 0; i < 300; ++i) {
        const auto unknowns = static_cast<std::size_t>(random.between(2.0, k_max_unknowns + 0.99));
        Problem problem(random, unknowns, 60, 500.0);
        problem.limit_single_unknowns(random);
        const Unknowns x =
            minimise_penalised(problem.hessian, problem.gradient, problem.rows, unknowns);
        EXPECT_LT(problem.gradient_at(x).norm(), 1e-6 * 500.0) << i;
        for (std::size_t r = 0; r < problem.rows.size(); r += 2) {
            violated += problem.rows[r].value + problem.rows[r].slope.dot(x) < 0.0 ? 1U : 0U;
        }
    }
    EXPECT_GT(violated, 1000U);
}

TEST(MinimisePenalised, RowsThatHoldDoNotMatter) {
    test::Random random(72);
    Problem problem(random, 5, 0, 1.0);
    const Unknowns free = minimise_penalised(problem.hessian, problem.gradient, {}, 5);
    Unknowns slope = random_slope(random, 5);
    problem.rows.push_back({slope, 1.0 - slope.dot(free), 1000.0});
    const Unknowns held = minimise_penalised(problem.hessian, problem.gradient, problem.rows, 5);
    EXPECT_LT((held - free).norm(), 1e-9);
}

}  // namespace
}  // namespace handhold::penalty_quadratic_test

#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <Eigen/Dense>

#include "engine/solver/newton/active_set.hpp"
#include "tests/engine/solver/scene.hpp"

// Rows between random bodies and their dense matrix, as an oracle for RowSystem. In a namespace of
// its own, because other tests have functions of the same names.
namespace handhold::test::dense_rows {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// Bodies, rows, and J W J^T by the dense definition: full Jacobian times block-diagonal inverse
// masses.
struct Problem {
    std::vector<SolverBody> bodies;
    std::vector<Mat3> inverse_inertias_ws;
    std::vector<Row> rows;

    void add_block(const RowBlock& block) {
        append_rows(bodies, block, static_cast<std::uint32_t>(rows.size()), rows);
    }
    void place_bodies(std::vector<SolverBody> placed) {
        bodies = std::move(placed);
        for (std::uint32_t i = 0; i < bodies.size(); ++i) {
            bodies[i].slot = i;
            inverse_inertias_ws.push_back(inverse_inertia_ws(bodies[i]));
        }
    }
    MatrixXd matrix() const {
        const auto dimension = static_cast<Eigen::Index>(6 * bodies.size());
        MatrixXd jacobian = MatrixXd::Zero(static_cast<Eigen::Index>(rows.size()), dimension);
        MatrixXd weights = MatrixXd::Zero(dimension, dimension);
        for (std::size_t i = 0; i < bodies.size(); ++i) {
            const auto at = static_cast<Eigen::Index>(6 * i);
            weights.block<3, 3>(at, at) = bodies[i].inverse_mass * Mat3::Identity();
            weights.block<3, 3>(at + 3, at + 3) = inverse_inertias_ws[i];
        }
        for (std::size_t i = 0; i < rows.size(); ++i) {
            const auto line = static_cast<Eigen::Index>(i);
            const Row& row = rows[i];
            jacobian.block<1, 3>(line, 6 * row.a) += row.linear_a.transpose();
            jacobian.block<1, 3>(line, 6 * row.a + 3) += row.angular_a.transpose();
            jacobian.block<1, 3>(line, 6 * row.b) -= row.linear_a.transpose();
            jacobian.block<1, 3>(line, 6 * row.b + 3) += row.angular_b.transpose();
        }
        return jacobian * weights * jacobian.transpose();
    }
    VectorXd values() const {
        VectorXd all(static_cast<Eigen::Index>(rows.size()));
        for (std::size_t i = 0; i < rows.size(); ++i) {
            all[static_cast<Eigen::Index>(i)] = rows[i].residual;
        }
        return all;
    }
};

inline RowSystem assembled(const Problem& problem, double alpha) {
    RowSystem system;
    system.assemble(problem.bodies, problem.inverse_inertias_ws, problem.rows);
    for (std::size_t i = 0; i < system.size(); ++i) {
        system.alpha()[i] = alpha * system.diagonal(i);
    }
    return system;
}

// The dense matrix with the same relative alpha on the diagonal.
inline MatrixXd regularised(const Problem& problem, double alpha) {
    MatrixXd matrix = problem.matrix();
    matrix.diagonal() *= 1.0 + alpha;
    return matrix;
}

inline VectorXd as_vector(std::span<const double> values) {
    return Eigen::Map<const VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

inline std::vector<SolverBody> random_bodies(std::size_t count, Random& random) {
    std::vector<SolverBody> bodies;
    for (std::size_t i = 0; i < count; ++i) {
        bodies.push_back(test::random_free_body(i + 1, random));
    }
    bodies.back() = test::fixed_body(count, bodies.back().pose_ws);
    bodies.front() = test::translating_body(1, 80.0, bodies.front().pose_ws);
    return bodies;
}

inline std::uint32_t random_index(std::size_t count, Random& random) {
    return static_cast<std::uint32_t>(random.engine()() % count);
}

inline Problem random_problem(std::size_t body_count, int drives, int contacts, Random& random) {
    Problem problem;
    problem.place_bodies(random_bodies(body_count, random));
    for (int i = 0; i < drives + contacts; ++i) {
        const std::uint32_t a = random_index(body_count, random);
        const std::uint32_t b =
            (a + 1 + random_index(body_count - 1, random)) % static_cast<std::uint32_t>(body_count);
        const RowKind drive = i % 2 == 0 ? RowKind::drive_point : RowKind::drive_weld;
        problem.add_block(test::random_block(i < drives ? drive : RowKind::contact, a, b, random));
        if (i >= drives) {
            problem.rows.back().residual = random.between(-0.2, 0.1);
        }
    }
    return problem;
}

}  // namespace handhold::test::dense_rows

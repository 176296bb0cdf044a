#include <cstdint>
#include <tuple>
#include <utility>
#include <vector>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "engine/solver/geometric_stiffness.hpp"
#include "engine/solver/triad_kernels.hpp"
#include "solver_scene.hpp"

namespace handhold::solver_stiffness_test {
namespace {

using test::Random;

// What the paper asks for, by a matrix library: the stiffness with its negative eigenvalues cut.
Mat3 clipped_stiffness(const Vec3& force, const Vec3& arm, double sign) {
    const Mat3 outer = force * arm.transpose();
    const Mat3 whole =
        sign * (force.dot(arm) * Mat3::Identity() - 0.5 * (outer + outer.transpose()));
    const Eigen::SelfAdjointEigenSolver<Mat3> parts(whole);
    return parts.eigenvectors() * parts.eigenvalues().cwiseMax(0.0).asDiagonal() *
           parts.eigenvectors().transpose();
}

// Forces and arms of any direction to each other, also along it, against it and nothing at all.
std::pair<Vec3, Vec3> random_force_and_arm(std::uint64_t number, Random& random) {
    const Vec3 force = random.vector(500.0);
    switch (number % 8) {
        case 0:
            return {force, 1e-3 * force};
        case 1:
            return {force, -1e-3 * force};
        case 2:
            return {Vec3::Zero(), random.vector(0.5)};
        default:
            return {force, random.vector(0.5)};
    }
}

TEST(GeometricStiffness, IsThePartWithEigenvaluesAboveZero) {
    Random random(1);
    for (std::uint64_t i = 0; i < 4000; ++i) {
        const auto [force, arm] = random_force_and_arm(i, random);
        const double size = force.norm() * arm.norm();
        for (const double sign : {1.0, -1.0}) {
            const Mat3 apart =
                positive_stiffness(force, arm, sign) - clipped_stiffness(force, arm, sign);
            ASSERT_LE(apart.norm(), 1e-9 * size) << "case " << i << ", sign " << sign;
        }
    }
}

// One triad between two bodies that may turn, as a kernel gets it.
struct Pair {
    SolverBody bodies[2];
    Vec3 force_ws;    // on a
    Vec3 arms_ws[2];  // from the centres

    explicit Pair(std::uint64_t number, Random& random)
        : bodies{test::random_free_body(1, random), test::random_free_body(2, random)} {
        std::tie(force_ws, arms_ws[0]) = random_force_and_arm(number, random);
        arms_ws[1] = random.vector(0.5);
    }
};

// Each body's inverse inertia with the stiffness, as the rows one by one have it.
Mat3 expected_inverse(const Pair& pair, std::size_t side) {
    const double sign = side == 0 ? 1.0 : -1.0;
    return stiffened(inverse_inertia_ws(pair.bodies[side]),
                     positive_stiffness(pair.force_ws, pair.arms_ws[side], sign));
}

std::vector<TriadBody> inverses_of(const TriadKernels& kernels, const Pair& pair) {
    std::vector<TriadBody> bodies(2);
    std::vector<TriadVector> arms(2);
    for (std::size_t side = 0; side < 2; ++side) {
        const SolverBody& body = pair.bodies[side];
        bodies[side].may_turn = true;
        bodies[side].inverse_inertia_bs = to_four(body.inverse_inertia_bs);
        const Mat3 axes = body.pose_ws.rotation.toRotationMatrix();
        for (int column = 0; column < 3; ++column) {
            bodies[side].axes.row[column] = to_four(Vec3(axes.col(column)));
        }
        arms[side].v = to_four(Vec3((side == 0 ? 1.0 : -1.0) * pair.arms_ws[side]));
    }
    std::vector<Triad> triads(1);
    triads[0].bodies[1] = 1;
    std::vector<TriadVector> lambdas(1, {to_four(pair.force_ws)});
    std::vector<Rows3> stiffness(2);
    TriadArrays arrays;
    arrays.bodies = bodies;
    arrays.moving = bodies.size();
    arrays.triads = triads;
    arrays.arms = arms;
    arrays.lambdas = lambdas;
    arrays.stiffness = stiffness;
    kernels.gather_stiffness(arrays);
    kernels.write_stiff_inertia(arrays);
    return bodies;
}

TEST(GeometricStiffness, OfTheKernelsIsThatOfRowsOneByOne) {
    Random random(2);
    for (std::uint64_t i = 0; i < 2000; ++i) {
        const Pair pair(i, random);
        for (const TriadKernels* kernels : {&triad_kernels(), &portable_triad_kernels()}) {
            const std::vector<TriadBody> bodies = inverses_of(*kernels, pair);
            for (std::size_t side = 0; side < 2; ++side) {
                Mat3 inverse;
                for (int row = 0; row < 3; ++row) {
                    inverse.row(row) = to_vec3(bodies[side].inverse_inertia.row[row]).transpose();
                }
                const Mat3 expected = expected_inverse(pair, side);
                ASSERT_LE((inverse - expected).norm(), 1e-9 * expected.norm())
                    << "case " << i << ", side " << side;
            }
        }
    }
}

}  // namespace
}  // namespace handhold::solver_stiffness_test

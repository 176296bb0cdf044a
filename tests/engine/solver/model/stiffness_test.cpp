#include <cmath>
#include <cstdint>
#include <tuple>
#include <utility>
#include <vector>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "engine/solver/model/geometric_stiffness.hpp"
#include "engine/solver/packed/triad_kernels.hpp"
#include "tests/engine/solver/scene.hpp"

namespace handhold::solver_stiffness_test {
namespace {

using test::Random;

// Oracle: the stiffness matrix with its negative eigenvalues set to 0, by Eigen.
Mat3 clipped_stiffness(const Vec3& force, const Vec3& arm, double sign) {
    const Mat3 outer = force * arm.transpose();
    const Mat3 whole =
        sign * (force.dot(arm) * Mat3::Identity() - 0.5 * (outer + outer.transpose()));
    const Eigen::SelfAdjointEigenSolver<Mat3> parts(whole);
    return parts.eigenvectors() * parts.eigenvalues().cwiseMax(0.0).asDiagonal() *
           parts.eigenvectors().transpose();
}

// Random forces and arms, including parallel, antiparallel and zero ones.
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

TEST(GeometricStiffness, IsThePositiveSemidefinitePart) {
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

// Oracle: second differences of the angle between the axes.
TEST(GeometricStiffness, OfAConeIsTheTorqueTimesTheSecondDerivativeOfItsAngle) {
    constexpr double k_step_rad = 1e-4;
    Random random(2);
    for (int i = 0; i < 1000; ++i) {
        const double angle = random.between(0.02, 1.5);
        const double torque = random.between(0.0, 1e3);
        const Quat frame = random.rotation();
        const Vec3 normal = frame * Vec3::UnitZ();
        const Vec3 other = frame * Vec3::UnitX();
        const Vec3 axis = rotation_about(normal, angle) * other;
        const auto angle_after = [&](const Vec3& turn) {
            const Vec3 turned = rotation_from_vector(turn) * axis;
            return std::atan2(turned.cross(other).norm(), turned.dot(other));
        };
        const Mat3 stiffness = cone_stiffness(torque, axis, other);
        for (const Vec3& along : {normal, axis, Vec3(normal.cross(axis))}) {
            const Vec3 turn = k_step_rad * along;
            const double second =
                (angle_after(turn) + angle_after(-turn) - 2.0 * angle) / (k_step_rad * k_step_rad);
            ASSERT_NEAR(along.dot(stiffness * along), torque * second,
                        1e-3 * torque / std::tan(angle) + 1e-6 * torque)
                << i;
        }
        ASSERT_TRUE(cone_stiffness(-torque, axis, other).isZero(0.0)) << i;
    }
}

// One triad between two bodies that can rotate, as a kernel receives it.
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

// Each body's inverse inertia with stiffness, by the scalar routines.
Mat3 expected_inverse(const Pair& pair, std::size_t side) {
    const double sign = side == 0 ? 1.0 : -1.0;
    return stiffened(inverse_inertia_ws(pair.bodies[side]),
                     positive_stiffness(pair.force_ws, pair.arms_ws[side], sign));
}

// The kernels' result, with the pair's bodies in lanes 0 and 1.
Bodies4 inverses_of(const TriadKernels& kernels, const Pair& pair) {
    TriadPlan plan;
    plan.build(std::vector<RowNode>{{{0, 1}, 3}}, std::vector<std::uint8_t>{1, 1});
    std::vector<Bodies4> bodies(1);
    std::vector<Ends4> ends(1);
    for (std::size_t side = 0; side < 2; ++side) {
        const SolverBody& body = pair.bodies[side];
        const Mat3 axes = body.pose_ws.rotation.toRotationMatrix();
        set_lane(side, body.inverse_inertia_bs, bodies[0].inverse_inertia_bs);
        set_lane(side, Vec3(axes.col(0)), bodies[0].axes.x);
        set_lane(side, Vec3(axes.col(1)), bodies[0].axes.y);
        set_lane(side, Vec3(axes.col(2)), bodies[0].axes.z);
        set_lane(side, Vec3((side == 0 ? 1.0 : -1.0) * pair.arms_ws[side]), ends[0].arm);
    }
    std::vector<TriadVector> lambdas = {{to_double4(pair.force_ws)}, {}};
    std::vector<WideSymmetric> stiffness(1);
    std::vector<Rows3> blocks(plan.block_count() + 1);
    TriadArrays arrays;
    arrays.bodies = bodies;
    arrays.body_ends = ends;
    arrays.stiffness = stiffness;
    arrays.lambdas = lambdas;
    arrays.blocks = blocks;
    arrays.plan = &plan;
    arrays.has_stiffness = true;
    kernels.gather_stiffness(arrays);
    kernels.multiply_out(arrays, 0.0);
    return bodies[0];
}

TEST(GeometricStiffness, KernelsAgreeWithTheSolveRowByRow) {
    Random random(2);
    for (std::uint64_t i = 0; i < 2000; ++i) {
        const Pair pair(i, random);
        for (const TriadKernels* kernels : {&triad_kernels(), &portable_triad_kernels()}) {
            const Bodies4 bodies = inverses_of(*kernels, pair);
            for (std::size_t side = 0; side < 2; ++side) {
                const WideSymmetric& w = bodies.inverse_inertia;
                Mat3 inverse;
                inverse << w.xx[side], w.xy[side], w.xz[side],  //
                    w.xy[side], w.yy[side], w.yz[side],         //
                    w.xz[side], w.yz[side], w.zz[side];
                const Mat3 expected = expected_inverse(pair, side);
                ASSERT_LE((inverse - expected).norm(), 1e-9 * expected.norm())
                    << "case " << i << ", side " << side;
            }
        }
    }
}

}  // namespace
}  // namespace handhold::solver_stiffness_test
